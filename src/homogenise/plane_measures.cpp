#include "homogenise/plane_measures.hpp"

#include "frame/frame_geometry.hpp"
#include "homogenise/measures.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace grainlaw::core {

namespace {

// Half the difference d of a plane fabric's eigenvalues, 1/2 + d and 1/2 - d.
double half_difference(const Tensor<2>& phi) { return std::hypot(0.5 * (phi[0] - phi[3]), phi[1]); }

}  // namespace

double anisotropy(const Tensor<2>& phi) {
  const double d = half_difference(phi);
  return (0.5 + d) / std::max(0.5 - d, 0.0) - 1;
}

// dev fabric : dev fabric = 2 d^2.
double fabric_intensity(const Tensor<2>& phi) { return 4 * half_difference(phi); }

double escaped_particles(const Problem<2>& problem, const Configuration<2>& at) {
  const auto& packing = *problem.packing;
  if (!packing.frame) return 0;
  const auto n = packing.size();
  const auto centre = [&](std::size_t p) {
    return Point{at.coordinates[p], at.coordinates[n + p]};
  };
  std::vector<Point> polygon;
  for (const int q : packing.frame->boundary)
    polygon.push_back(centre(static_cast<std::size_t>(q)));
  double escaped = 0;
  for (std::size_t p = 0; p < n; ++p) {
    const auto node = static_cast<std::size_t>(problem.space->node[p]);
    if (!problem.space->boundary[node] && !is_inside(polygon, centre(p))) ++escaped;
  }
  return escaped;
}

template <>
Vec<2> ContactView<2>::tangential_force_vector() const {
  const double per_length = tangential_force[0] / length<2>(branch);
  return {-branch[1] * per_length, branch[0] * per_length};
}

}  // namespace grainlaw::core
