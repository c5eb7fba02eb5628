// What tests of the boundary conditions share: all of them on one packing, the forces of the
// surroundings, and admissible motions.
#pragma once

#include "firm_packing.hpp"
#include "state/serialise.hpp"
#include "support.hpp"

#include <random>
#include <string>
#include <utility>
#include <vector>

namespace grainlaw::core::test {

inline Tensor stress_of(const State& state) {
  const auto& p = state.current().stress;
  return {p[0], p[1], p[2], p[3]};
}

inline Tensor deformation_of(const State& state) {
  const auto& f = state.current().deformation;
  return {f[0], f[1], f[2], f[3]};
}

// The layer of Liu, Bosco & Suiker (2017), section 5: periodic to left and right, the bottom held,
// the top held in x and under uniform stress in y.
inline Sides layer_sides(SideRow row = SideRow::discs) {
  Sides sides;
  sides[left_side] = sides[right_side] = {SideRule::p, SideRule::p, SideRotation::periodic};
  sides[bottom_side] = {SideRule::d, SideRule::d, SideRotation::fixed, row};
  sides[top_side] = {SideRule::d, SideRule::t, SideRotation::free, row};
  return sides;
}

inline MaterialDescription describe_layer(const Packing& packing, double p22,
                                          SideRow row = SideRow::discs, double tolerance = 1e-10) {
  auto description = describe(packing, rough_law(), BoundaryType::mixed, tolerance);
  description.boundary.sides = layer_sides(row);
  description.boundary.stress[3] = p22;
  return description;
}

using Spaces = std::vector<std::pair<std::string, MaterialDescription>>;

inline Spaces all_spaces(const Packing& packing) {
  Spaces all;
  all.emplace_back("periodic-cell", describe(packing, rough_law()));
  all.emplace_back("frame-p", describe(packing, rough_law(), BoundaryType::frame_p));
  all.emplace_back("frame-d", describe(packing, rough_law(), BoundaryType::frame_d));
  all.emplace_back("frame-d, locked", describe(packing, locked_law(), BoundaryType::frame_d));
  all.emplace_back("frame-t", describe(packing, rough_law(), BoundaryType::frame_t));
  auto plates = describe(packing, rough_law(), BoundaryType::mixed);
  plates.boundary.sides = layer_sides();
  plates.boundary.sides[top_side] = plates.boundary.sides[bottom_side];
  all.emplace_back("between plates", plates);
  auto layer = describe(packing, rough_law(), BoundaryType::mixed);
  layer.boundary.sides = layer_sides();
  all.emplace_back("layer under a given F", layer);
  const double pressure = stress_of(State(make_material(describe(packing, rough_law()))))[3];
  all.emplace_back("layer", describe_layer(packing, 1.2 * pressure));
  all.emplace_back("layer between rows", describe_layer(packing, 1.2 * pressure, SideRow::rigid));
  auto biaxial = describe(packing, rough_law(), BoundaryType::mixed);
  biaxial.boundary.sides.fill({SideRule::d, SideRule::d, SideRotation::fixed});
  biaxial.boundary.stress[0] = 1.1 * pressure;
  all.emplace_back("biaxial", biaxial);
  auto inside = describe(packing, rough_law(), BoundaryType::frame_p);
  inside.boundary.inner_rotation = InnerRotation::fixed;
  all.emplace_back("frame-p, locked inside", inside);
  return all;
}

// Weighted force on j.
inline std::array<double, 2> force_on_j(const ContactView& c) {
  const double d = std::hypot(c.branch[0], c.branch[1]);
  return {c.weight * (c.normal_force * c.branch[0] - c.tangential_force[0] * c.branch[1]) / d,
          c.weight * (c.normal_force * c.branch[1] + c.tangential_force[0] * c.branch[0]) / d};
}

// Force that the surroundings exert on every particle of a frame, and the moment.
struct Surroundings {
  std::vector<std::array<double, 2>> force;
  std::vector<double> moment;
  double scale = 0;  // mean normal force
};

inline Surroundings surroundings(const State& state) {
  const Material& material = state.material();
  const auto n = material.packing.size();
  Surroundings result{std::vector<std::array<double, 2>>(n), std::vector<double>(n), 0};
  const auto views = contact_views(material.problem(), state.current());
  for (const auto& c : views) {
    const auto i = static_cast<std::size_t>(c.i);
    const auto j = static_cast<std::size_t>(c.j);
    const auto f = force_on_j(c);
    for (std::size_t k = 0; k < 2; ++k) {
      result.force[i][k] += f[k];
      result.force[j][k] -= f[k];
    }
    const auto& r = material.packing.radius;
    const double couple = c.weight * c.tangential_force[0] * std::hypot(c.branch[0], c.branch[1]);
    result.moment[i] += couple * r[i] / (r[i] + r[j]);
    result.moment[j] += couple * r[j] / (r[i] + r[j]);
    result.scale += c.normal_force / static_cast<double>(views.size());
  }
  return result;
}

// Reference positions that F acts on.
inline const std::vector<double>& reference_positions(const Material& material) {
  return material.space.bound_to_axes() ? material.space.reference : material.packing.position;
}

inline Tensor stress_of_boundary(const State& state) {
  const Material& material = state.material();
  const auto n = material.packing.size();
  const auto& x = reference_positions(material);
  const auto around = surroundings(state);
  Tensor stress{};
  for (const int q : material.packing.frame->boundary) {
    const auto p = static_cast<std::size_t>(q);
    for (std::size_t k = 0; k < 4; ++k) {
      stress[k] += around.force[p][k / 2] * x[k % 2 * n + p] / material.space.reference_volume;
    }
  }
  return stress;
}

// (1/V) sum x (x) A
inline Tensor average_deformation(const State& state) {
  const auto& packing = state.material().packing;
  const auto& x = state.current().coordinates;
  Tensor mean{};
  for (std::size_t q = 0; q < packing.frame->boundary.size(); ++q) {
    const auto p = static_cast<std::size_t>(packing.frame->boundary[q]);
    for (std::size_t k = 0; k < 4; ++k) {
      mean[k] += x[k / 2 * packing.size() + p] * packing.frame->area[q][k % 2] * packing.thickness /
                 state.material().space.reference_volume;
    }
  }
  return mean;
}

struct Motion {
  Tensor deformation{};
  std::vector<double> x, rotation;  // of particles, component-major
};

// Any change of F with any fluctuation of the space of a frame.
inline Motion random_motion(const State& state, std::mt19937& random) {
  const Material& material = state.material();
  const auto& space = material.space;
  const auto n = material.packing.size();
  std::uniform_real_distribution<double> uniform(-1, 1);
  Motion motion;
  for (double& value : motion.deformation) value = uniform(random);
  std::vector<double> w(3 * space.nodes);
  for (double& value : w) value = material.packing.radius[0] * uniform(random);
  for (std::size_t q = 0; q < space.nodes && !space.identity; ++q) {
    for (std::size_t k = 0; k < 3; ++k) {
      if ((space.fixed[q] >> k & 1U) != 0) w[k * space.nodes + q] = 0;
    }
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& average = space.average[i];
    for (std::size_t r = 0; r < average.rows; ++r) {
      double off = 0;
      for (std::size_t k = 0; k < average.node.size(); ++k) {
        off += average.row[k][r] * w[i * space.nodes + static_cast<std::size_t>(average.node[k])];
      }
      for (std::size_t k = 0; k < average.node.size(); ++k) {
        w[i * space.nodes + static_cast<std::size_t>(average.node[k])] -= off * average.row[k][r];
      }
    }
  }
  const Tensor F = deformation_of(state);
  const double det = F[0] * F[3] - F[1] * F[2];
  const Tensor inverse{F[3] / det, -F[1] / det, -F[2] / det, F[0] / det};
  // F^-1 x moves by dF as well as X does where fluctuations may turn.
  std::vector<double> reference = space.reference;
  if (!space.bound_to_axes()) {
    const auto& x = state.current().coordinates;
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t p = 0; p < n; ++p) {
        reference.push_back(inverse[2 * k] * x[p] + inverse[2 * k + 1] * x[n + p]);
      }
    }
  }
  motion.x.resize(2 * n);
  motion.rotation.resize(n);
  for (std::size_t p = 0; p < n; ++p) {
    const auto q = static_cast<std::size_t>(space.node[p]);
    for (std::size_t k = 0; k < 2; ++k) {
      motion.x[k * n + p] = motion.deformation[2 * k] * reference[p] +
                            motion.deformation[2 * k + 1] * reference[n + p] +
                            w[k * space.nodes + q];
    }
    motion.rotation[p] = w[2 * space.nodes + q];
  }
  return motion;
}

// dP/dF by central differences, each from the same committed state.
inline Tangent central_differences(State& state, const Tensor& F, double step) {
  Tangent tangent{};
  for (std::size_t k = 0; k < 4; ++k) {
    Tensor stress[2];
    for (int side = 0; side < 2; ++side) {
      Tensor at = F;
      at[k] += side == 0 ? step : -step;
      const Evaluation result = evaluate(state, at);
      EXPECT_EQ(result.status, GRAINLAW_OK) << result.report.message;
      stress[side] = result.stress;
    }
    for (std::size_t m = 0; m < 4; ++m) {
      if (state.material().space.found[m]) continue;
      tangent[4 * m + k] = (stress[0][m] - stress[1][m]) / (2 * step);
    }
  }
  return tangent;
}

}  // namespace grainlaw::core::test
