// Subspace extrapolation. Where a relaxation creeps, its last moves point along the slowest modes: a Galerkin projection on
// them finds the place that it creeps to (as Anderson 1965 does by the least residual instead, which
// stiff modes dominate).
#pragma once

#include "contact/records.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// Spanned by so many of the last moves.
inline constexpr std::size_t moves_seen = 3;

template <int D>
class SubspaceExtrapolation {
 public:
  static constexpr std::size_t moves = moves_seen;

  void reserve(std::size_t nodes);
  // Forget where the relaxation has been.
  void forget() { seen_ = 0; }
  // Where it is now, the forces there, and their relative residual.
  void see(std::span<const ParticleRecord<D>> place, std::span<const ForceRecord<D>> forces,
           double residual);
  // Whether enough has been seen, and the residual fell slowly meanwhile.
  [[nodiscard]] bool slow() const;

  // Move the records, which are at the last place seen, to where the forces do no work along the
  // last moves, by secants; no component by more than `limit` [m]. Only the newest moves count up to
  // where the stiffness [N/m] along all of them falls below `least`: beyond lie unstable equilibria,
  // which nothing goes back to by itself. False, and nothing moves, when it does so along the newest.
  bool extrapolate(std::span<ParticleRecord<D>> records, double limit, double least) const;

 private:
  struct Seen {
    std::vector<ParticleRecord<D>> place;
    std::vector<ForceRecord<D>> forces;
    double residual;
  };
  [[nodiscard]] const Seen& newest(std::size_t before = 0) const {
    return ring_[(seen_ - 1 - before) % ring_.size()];
  }

  std::array<Seen, moves + 1> ring_;
  std::size_t seen_ = 0;
};

}  // namespace grainlaw::core
