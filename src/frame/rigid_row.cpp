#include "frame/rigid_row.hpp"

#include "frame/frame.hpp"

#include <array>
#include <cmath>

namespace grainlaw::core {

void straighten(const Packing& packing, std::size_t side, BoundarySpace<2>& space) {
  const Frame& frame = *packing.frame;
  const auto n = packing.size();
  const auto corner = corner_indices(frame);
  const std::size_t count = frame.boundary.size();
  const std::size_t end = side < 3 ? corner[side + 1] : count;
  const auto at = [&](std::size_t index) {
    const auto p = static_cast<std::size_t>(frame.boundary[index % count]);
    return std::array{undeformed(packing)[p], undeformed(packing)[n + p]};
  };
  const auto a = at(corner[side]);
  const auto b = at(end);
  const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
  const std::array along{(b[0] - a[0]) / length, (b[1] - a[1]) / length};
  const std::array normal{-along[1], along[0]};
  const auto height = [&](const std::array<double, 2>& x) {
    return normal[0] * (x[0] - a[0]) + normal[1] * (x[1] - a[1]);
  };
  double area = 0;
  for (std::size_t q = corner[side]; q < end; ++q) {
    const auto x = at(q);
    const auto y = at(q + 1);
    area += 0.5 * (height(x) + height(y)) * (along[0] * (y[0] - x[0]) + along[1] * (y[1] - x[1]));
  }
  for (std::size_t q = corner[side]; q <= end; ++q) {
    const auto p = static_cast<std::size_t>(frame.boundary[q % count]);
    const double off = height(at(q)) - area / length;
    for (std::size_t k = 0; k < 2; ++k) {
      space.reference[k * n + p] -= off * normal[k];
      space.offset[k * n + p] += off * normal[k];
    }
  }
}

}  // namespace grainlaw::core
