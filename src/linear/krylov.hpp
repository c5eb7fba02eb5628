// Krylov methods with DILU factors, for one right-hand side or one per lane.
#pragma once

#include "base/simd.hpp"
#include "linear/dilu.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// Number per lane; for one vector all lanes agree.
struct alignas(64) LaneScalars {
  double lane[Dilu::width] = {};
};

// Solver of A x = b. Entry is BlockColumn<8> for one vector, Together<8> for several, with floats for
// iterates in single precision, which reduce the residual by at most 1e-5. It stops when
// the norm of the preconditioned residual is below tolerance x that of b, or after most_products
// (IDR up to four more). It returns the number of products, and the caller checks the residual.
// After a breakdown x is the last iterate. A may be singular if b is in its range.
template <class Entry>
class Krylov {
 public:
  using Scalars = LaneScalars;
  using Right = InDouble<Entry>;

  // BiCGStab [vandervorst1992] in single precision: little work besides the products, but it may
  // stall.
  int bicgstab(Dilu& dilu, std::span<const Right> b, std::span<Right> x, const Scalars& tolerance,
               int most_products);
  // IDR(4) [vangijzen2011] in double precision: more work besides the products, but steadier.
  int idr(Dilu& dilu, std::span<const Right> b, std::span<Right> x, const Scalars& tolerance,
          int most_products);

  // Reserves memory for so many nodes, untouched until it is needed.
  void reserve(std::size_t nodes);

 private:
  static constexpr std::size_t shadows = 4;
  using Vector = std::vector<Entry>;
  using Four = std::array<Scalars, shadows>;

  void start(Dilu& dilu, std::span<const Right> b, const Scalars& tolerance);
  void finish(Dilu& dilu, std::span<Right> x);
  [[nodiscard]] bool any_left() const;
  void see_residual(const Scalars& square);
  // Quotient; 0 in converged lanes and where the method breaks down.
  [[nodiscard]] double quotient(double over, double under, std::size_t lane) const {
    return left_[lane] && under != 0 ? over / under : 0.0;
  }
  void start_shadows();
  void project_on_shadows(const Vector& a, Four& result, Scalars& square) const;
  void step_in_space(Dilu& dilu, std::size_t k);
  void enter_next_space(Dilu& dilu);

  Vector residual_, solution_;
  Vector shadow_, direction_, image_, second_;  // for BiCGStab
  std::array<Vector, shadows> moves_, images_;  // for IDR
  // Numbers per entry of the residual: one for all lanes, or one per lane.
  std::array<simd::Column<double>, shadows> shadows_;
  std::array<Four, shadows> matrix_{};  // of shadows by images
  Four right_{};                        // of shadows by the residual
  Scalars omega_{};
  Scalars largest_{};                     // entry of b, the unit of iterates in single precision
  Scalars enough_{};                      // square of the target residual
  std::array<bool, Dilu::width> left_{};  // lanes that have not converged
};

}  // namespace grainlaw::core
