// Krylov methods with DILU factors, for one right-hand side or one in every lane.
#pragma once

#include "base/simd.hpp"
#include "linear/dilu.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// Entry: BlockColumn<8>, or Together<8> for several. x of A x = b, until the norm of the residual that
// the factors make of it is below tolerance x that of b, or so many products were spent (by IDR up to
// four more): the caller checks what was reached. Where a method breaks down x stays what it was last.
// A may be singular where b is in its range. Returns the products.
template <class Entry>
class Krylov {
 public:
  // A number for every lane; of one vector all are the same.
  struct alignas(64) Scalars {
    double lane[Dilu::width] = {};
  };

  // BiCGStab (van der Vorst 1992): little to do beside the products, but it may stall.
  int bicgstab(Dilu& dilu, std::span<const Entry> b, std::span<Entry> x, const Scalars& tolerance,
               int most_products);
  // IDR(4) (van Gijzen & Sonneveld 2011): more of that, and steadier.
  int idr(Dilu& dilu, std::span<const Entry> b, std::span<Entry> x, const Scalars& tolerance,
          int most_products);

  // Room for so many nodes, untouched until it is needed.
  void reserve(std::size_t nodes);

 private:
  static constexpr std::size_t shadows = 4;
  using Vector = std::vector<Entry>;
  using Four = std::array<Scalars, shadows>;

  void start(Dilu& dilu, std::span<const Entry> b, const Scalars& tolerance);
  [[nodiscard]] bool any_left() const;
  void see_residual(const Scalars& square);
  // Nothing in lanes that are done, or where the method breaks down.
  [[nodiscard]] double quotient(double over, double under, std::size_t lane) const {
    return left_[lane] && under != 0 ? over / under : 0.0;
  }
  void start_shadows();
  void project_on_shadows(const Vector& a, Four& result, Scalars& square) const;
  void step_in_space(Dilu& dilu, std::size_t k);
  void enter_next_space(Dilu& dilu);

  Vector residual_, solution_;
  Vector shadow_, direction_, image_, second_;  // of BiCGStab
  std::array<Vector, shadows> moves_, images_;  // of IDR
  // Of an entry of the residual one number for all lanes, or one for each.
  std::array<simd::Column<double>, shadows> shadows_;
  std::array<Four, shadows> matrix_{};  // of shadows by images
  Four right_{};                        // of shadows by the residual
  Scalars omega_{};
  Scalars enough_{};                      // square of the residual
  std::array<bool, Dilu::width> left_{};  // lanes that are not done
};

}  // namespace grainlaw::core
