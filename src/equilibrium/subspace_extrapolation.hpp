// Subspace extrapolation. Where a relaxation creeps, its last displacements point along the slowest
// modes, and a Galerkin projection on them finds its limit. [anderson1965] uses the least residual
// instead, which stiff modes dominate.
#pragma once

#include "contact/records.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// Number of displacements that span the subspace.
inline constexpr std::size_t moves_seen = 3;

template <int D>
class SubspaceExtrapolation {
 public:
  static constexpr std::size_t moves = moves_seen;

  void reserve(std::size_t nodes);
  // Clears the recorded path.
  void forget() { seen_ = 0; }
  // Records the present positions, the forces there and their relative residual.
  void see(std::span<const ParticleRecord<D>> place, std::span<const ForceRecord<D>> forces,
           double residual);
  // True if the record is full and the residual fell slowly over it.
  [[nodiscard]] bool slow() const;

  // Moves the records from the last recorded positions to where forces do no work along the
  // displacements, by secants. No component moves by more than `limit` [m]. Only the newest
  // displacements count, as long as the stiffness along them is at least `least` [N/m]: beyond lie
  // unstable equilibria. If none counts, it returns false and moves nothing.
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
