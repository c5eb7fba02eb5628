#include "equilibrium/subspace_extrapolation.hpp"

#include "base/capacity.hpp"
#include "base/constants.hpp"
#include "base/simd.hpp"
#include "math/dimension.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

using namespace simd;
constexpr std::size_t width = 4;
constexpr std::size_t moves = moves_seen;

// Recorded positions and forces, newest first.
struct Path {
  std::array<const double*, moves + 1> place, force;
  std::size_t doubles;
};

GRAINLAW_INLINE Record move_of(const Path& path, std::size_t a, std::size_t k) {
  return load<4>(path.place[a] + k) - load<4>(path.place[a + 1] + k);
}

// Sums over the records, with displacements d_a and forces r.
struct Products {
  double lengths[moves][moves];  // d_a . d_b
  double work[moves][moves];     // -d_a . (change of r by d_b)
  double left[moves];            // d_a . r
};

GRAINLAW_CLONES void find_products(const Path& path, Products& products) {
  Record lengths[moves][moves]{}, work[moves][moves]{}, left[moves]{};
  for (std::size_t k = 0; k < path.doubles; k += width) {
    Record move[moves], answer[moves];
#pragma GCC unroll 3
    for (std::size_t a = 0; a < moves; ++a) {
      move[a] = move_of(path, a, k);
      answer[a] = load<4>(path.force[a + 1] + k) - load<4>(path.force[a] + k);
    }
#pragma GCC unroll 3
    for (std::size_t a = 0; a < moves; ++a) {
      left[a] += move[a] * load<4>(path.force[0] + k);
#pragma GCC unroll 3
      for (std::size_t b = 0; b < moves; ++b) {
        lengths[a][b] += move[a] * move[b];
        work[a][b] += move[a] * answer[b];
      }
    }
  }
  for (std::size_t a = 0; a < moves; ++a) {
    products.left[a] = sum(left[a]);
    for (std::size_t b = 0; b < moves; ++b) {
      products.lengths[a][b] = sum(lengths[a][b]);
      products.work[a][b] = sum(work[a][b]);
    }
  }
}

GRAINLAW_INLINE Record extrapolated_move(const Path& path, const double* share, std::size_t k) {
  Record result = share[0] * move_of(path, 0, k);
#pragma GCC unroll 2
  for (std::size_t a = 1; a < moves; ++a) result += share[a] * move_of(path, a, k);
  return result;
}

GRAINLAW_CLONES double longest_extrapolation(const Path& path, const double* share) {
  Record longest{};
  for (std::size_t k = 0; k < path.doubles; k += width) {
    longest = largest(longest, magnitude(extrapolated_move(path, share, k)));
  }
  return most(longest);
}

GRAINLAW_CLONES void add_extrapolation(const Path& path, const double* share, double* to) {
  for (std::size_t k = 0; k < path.doubles; k += width) {
    store(to + k, load<4>(to + k) + extrapolated_move(path, share, k));
  }
}

using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, moves, moves>;
using Shares = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, moves, 1>;

bool positive(const Square& matrix) { return Eigen::LLT<Square>(matrix).info() == Eigen::Success; }

// Number of the newest displacements that are independent and have at least this stiffness along
// all of them.
Eigen::Index count_stable(const Square& lengths, const Square& work, double least) {
  const Square symmetric = 0.5 * (work + work.transpose());
  for (Eigen::Index n = 1; n <= lengths.rows(); ++n) {
    const Square own = lengths.topLeftCorner(n, n).diagonal().asDiagonal();
    if (!positive(lengths.topLeftCorner(n, n) - tuned::independent_move * own) ||
        !positive(symmetric.topLeftCorner(n, n) - least * lengths.topLeftCorner(n, n))) {
      return n - 1;
    }
  }
  return lengths.rows();
}

}  // namespace

template <int D>
void SubspaceExtrapolation<D>::reserve(std::size_t nodes) {
  for (Seen& seen : ring_) {
    resize_with_capacity(seen.place, nodes);
    resize_with_capacity(seen.forces, nodes);
  }
}

template <int D>
void SubspaceExtrapolation<D>::see(std::span<const ParticleRecord<D>> place,
                                   std::span<const ForceRecord<D>> forces, double residual) {
  Seen& seen = ring_[seen_++ % ring_.size()];
  std::copy(place.begin(), place.end(), seen.place.begin());
  std::copy_n(forces.begin(), place.size(), seen.forces.begin());
  seen.residual = residual;
}

template <int D>
bool SubspaceExtrapolation<D>::slow() const {
  return seen_ > moves && newest().residual > tuned::creeping * newest(moves).residual;
}

template <int D>
bool SubspaceExtrapolation<D>::extrapolate(std::span<ParticleRecord<D>> records, double limit,
                                           double least) const {
  Path path{{}, {}, Dimension<D>::lanes * records.size()};
  for (std::size_t a = 0; a <= moves; ++a) {
    path.place[a] = &newest(a).place[0].x;
    path.force[a] = &newest(a).forces[0].x;
  }
  Products products;
  find_products(path, products);
  using AsGiven = Eigen::Map<const Eigen::Matrix<double, moves, moves, Eigen::RowMajor>>;
  const Square work = AsGiven(&products.work[0][0]);
  const auto stable = count_stable(AsGiven(&products.lengths[0][0]), work, least);
  if (stable == 0) return false;
  const Shares left = Eigen::Map<const Shares>(products.left, stable);
  double share[moves]{};
  Eigen::Map<Shares>(share, stable) = work.topLeftCorner(stable, stable).partialPivLu().solve(left);
  const double longest = longest_extrapolation(path, share);
  if (!std::isfinite(longest)) return false;
  for (double& part : share) part *= std::min(1.0, limit / longest);
  add_extrapolation(path, share, &records[0].x);
  return true;
}

template class SubspaceExtrapolation<2>;
template class SubspaceExtrapolation<3>;

}  // namespace grainlaw::core
