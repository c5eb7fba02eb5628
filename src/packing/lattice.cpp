#include "packing/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainlaw::core {

namespace {

struct Vector {
  double x = 0, y = 0;
  std::array<std::int64_t, 2> count{};  // in vectors of the given basis

  [[nodiscard]] double square() const { return x * x + y * y; }
  [[nodiscard]] double most() const {
    return static_cast<double>(std::max(std::abs(count[0]), std::abs(count[1])));
  }
};

}  // namespace

double longest_vector(const Lattice& cell) {
  return std::max(std::hypot(cell[0], cell[2]), std::hypot(cell[1], cell[3]));
}

Basis reduced_basis(const Lattice& cell) {
  constexpr double too_many = 1e15;  // lattice vectors: doubles resolve no more
  constexpr int most_steps = 100;
  Vector a{cell[0], cell[2], {1, 0}};
  Vector b{cell[1], cell[3], {0, 1}};
  for (int step = 0; step < most_steps; ++step) {
    // Rotates the basis instead of swapping its vectors, so that det stays positive.
    if (a.square() > b.square()) {
      std::swap(a, b);
      b = {-b.x, -b.y, {-b.count[0], -b.count[1]}};
    }
    const double times = std::round((a.x * b.x + a.y * b.y) / a.square());
    if (!(std::abs(times) >= 1) || !(std::abs(times) * a.most() < too_many)) break;
    const auto n = static_cast<std::int64_t>(times);
    b = {b.x - times * a.x,
         b.y - times * a.y,
         {b.count[0] - n * a.count[0], b.count[1] - n * a.count[1]}};
  }
  return {{a.x, b.x, a.y, b.y}, {a.count[0], b.count[0], a.count[1], b.count[1]}};
}

}  // namespace grainlaw::core
