#include "packing/row_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace grainlaw::core {

std::vector<std::int32_t> row_order(const Packing& packing) {
  constexpr std::size_t small = 1024;  // records of 32 bytes fill 32 kB
  const std::size_t n = packing.size();
  if (n <= small) return {};
  const auto side = static_cast<std::size_t>(packing.dimension);
  const auto h = [&](std::size_t row, std::size_t column) {
    return packing.cell[side * row + column];
  };
  const double area = h(0, 0) * h(1, 1) - h(0, 1) * h(1, 0);
  const double rows = std::max(1.0, std::floor(0.5 * std::sqrt(static_cast<double>(n))));
  std::vector<std::array<double, 2>> key(n);  // row, and distance along the path within it
  for (std::size_t p = 0; p < n; ++p) {
    const double x = packing.position[p];
    const double y = packing.position[n + p];
    const double along = (h(1, 1) * x - h(0, 1) * y) / area;
    const double across = (h(0, 0) * y - h(1, 0) * x) / area;
    const double row = std::floor(rows * (across - std::floor(across)));
    const double fraction = along - std::floor(along);
    key[p] = {row, std::fmod(row, 2) == 0 ? fraction : 1 - fraction};
  }
  std::vector<std::int32_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return key[static_cast<std::size_t>(a)] < key[static_cast<std::size_t>(b)];
  });
  return order;
}

}  // namespace grainlaw::core
