// Hill-Mandel: the converged forces do the work P : dF on every admissible variation, and on a
// frame the forces of the boundary particles make the same stress.
#include "support.hpp"

#include <random>

namespace grainlaw::core::test {
namespace {

constexpr double bar = 1e-8;

std::vector<MaterialDescription> descriptions(BoundaryType boundary) {
  std::vector<MaterialDescription> all;
  for (const auto& law : {rough_law(), locked_law(), smooth_law()}) {
    all.push_back(describe(small_packing(), law, boundary));
  }
  if (boundary == BoundaryType::frame_p) {
    all.push_back(describe(small_packing(), rough_law(), boundary));
    all.back().boundary.weight = ContactWeight::one;
  }
  return all;
}

// Calls visit(state, F) at committed equilibria after rotated increments.
template <class Visit>
void at_equilibria(const MaterialDescription& description, Visit&& visit) {
  State state(make_material(description));
  const Tensor path[] = {
      {1.001, 2e-4, -1e-4, 0.998}, {1.001, 0.003, 0.001, 0.997}, {0.999, 0.003, 0.002, 0.998}};
  for (const Tensor& F : path) {
    const Tensor turned = product(rotation(0.3), F);
    advance(state, turned);
    visit(state, turned);
  }
}

Tensor stress_of(const State& state) {
  const auto& p = state.current().stress;
  return {p[0], p[1], p[2], p[3]};
}

// Weighted force on j.
std::array<double, 2> force_on_j(const ContactView& c) {
  const double d = std::hypot(c.branch[0], c.branch[1]);
  return {c.weight * (c.normal_force * c.branch[0] - c.tangential_force[0] * c.branch[1]) / d,
          c.weight * (c.normal_force * c.branch[1] + c.tangential_force[0] * c.branch[0]) / d};
}

void expect_equal_work(const State& state, const Tensor& F, std::mt19937& random) {
  const Material& material = state.material();
  const auto& space = material.space;
  const double det = F[0] * F[3] - F[1] * F[2];
  const Tensor inverse{F[3] / det, -F[1] / det, -F[2] / det, F[0] / det};
  const double radius = material.packing.radius[0];
  std::uniform_real_distribution<double> uniform(-1, 1);

  Tensor variation{};  // dF
  for (double& value : variation) value = uniform(random);
  std::array<std::vector<double>, 3> fluctuation;
  for (auto& component : fluctuation) {
    for (std::size_t q = 0; q < space.nodes; ++q) component.push_back(uniform(random));
  }
  for (std::size_t q = 0; q < space.nodes; ++q) {
    fluctuation[0][q] *= radius;
    fluctuation[1][q] *= radius;
    if (!space.fixed.empty() && space.fixed[q]) fluctuation[0][q] = fluctuation[1][q] = 0;
  }

  double work = 0;
  double magnitude = 0;
  for (const auto& c : contact_views(material.problem(), state.current())) {
    const auto i = static_cast<std::size_t>(c.i);
    const auto j = static_cast<std::size_t>(c.j);
    const auto a = static_cast<std::size_t>(space.node[i]);
    const auto b = static_cast<std::size_t>(space.node[j]);
    const double lx = inverse[0] * c.branch[0] + inverse[1] * c.branch[1];
    const double ly = inverse[2] * c.branch[0] + inverse[3] * c.branch[1];
    const double dx = variation[0] * lx + variation[1] * ly + fluctuation[0][b] - fluctuation[0][a];
    const double dy = variation[2] * lx + variation[3] * ly + fluctuation[1][b] - fluctuation[1][a];
    const auto f = force_on_j(c);
    double part = f[0] * dx + f[1] * dy;
    if (material.law.rotating()) {
      const auto& r = material.packing.radius;
      const double lever = r[i] / (r[i] + r[j]);
      part -= c.weight * c.tangential_force[0] * std::hypot(c.branch[0], c.branch[1]) *
              (lever * fluctuation[2][a] + (1 - lever) * fluctuation[2][b]);
    }
    work -= part / space.reference_volume;
    magnitude += std::abs(part) / space.reference_volume;
  }
  EXPECT_NEAR(work, dot(stress_of(state), variation), bar * magnitude);
  EXPECT_LE(bar * magnitude, 1e-6 * norm(stress_of(state)));  // the bar means something
}

TEST(hill_mandel, contacts_work_as_much_as_the_stress_of_a_cell) {
  std::mt19937 random(7);
  for (const auto& description : descriptions(BoundaryType::periodic_cell)) {
    at_equilibria(description, [&](const State& state, const Tensor& F) {
      for (int k = 0; k < 10; ++k) expect_equal_work(state, F, random);
    });
  }
}

TEST(hill_mandel, contacts_work_as_much_as_the_stress_of_a_frame) {
  std::mt19937 random(8);
  for (const auto& description : descriptions(BoundaryType::frame_p)) {
    at_equilibria(description, [&](const State& state, const Tensor& F) {
      for (int k = 0; k < 10; ++k) expect_equal_work(state, F, random);
    });
  }
}

// Force that the surroundings exert on every particle of a frame, and the moment.
struct Surroundings {
  std::vector<std::array<double, 2>> force;
  std::vector<double> moment;
  double scale = 0;  // mean normal force
};

Surroundings surroundings(const State& state) {
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

TEST(hill_mandel, boundary_forces_make_the_stress_of_a_frame) {  // eq. 23
  for (const auto& description : descriptions(BoundaryType::frame_p)) {
    at_equilibria(description, [](const State& state, const Tensor&) {
      const Material& material = state.material();
      const auto& packing = material.packing;
      const auto around = surroundings(state);
      const double volume = polygon_area(packing) * packing.thickness;
      EXPECT_NEAR(volume / material.space.reference_volume, 1, 1e-13);
      Tensor stress{};
      for (const int q : packing.frame->boundary) {
        const auto p = static_cast<std::size_t>(q);
        const double x[2] = {packing.position[p], packing.position[packing.size() + p]};
        for (std::size_t i = 0; i < 2; ++i) {
          for (std::size_t j = 0; j < 2; ++j) {
            stress[2 * i + j] += around.force[p][i] * x[j] / volume;
          }
        }
      }
      EXPECT_LE(relative_difference(stress, stress_of(state)), bar);
    });
  }
}

TEST(hill_mandel, opposite_boundary_forces_cancel) {  // eqs. 20-22
  for (const auto& description : descriptions(BoundaryType::frame_p)) {
    at_equilibria(description, [](const State& state, const Tensor&) {
      const Material& material = state.material();
      const auto& packing = material.packing;
      const auto& frame = *packing.frame;
      const auto around = surroundings(state);
      const double tolerance = 2 * material.solver.tolerance * around.scale;
      const bool rotating = material.law.rotating();
      double largest = 0;
      for (std::size_t q = 0; q < frame.boundary.size(); ++q) {
        if (frame.partner[q] < 0) continue;
        const auto p = static_cast<std::size_t>(frame.boundary[q]);
        const auto opposite = static_cast<std::size_t>(frame.partner[q]);
        for (std::size_t k = 0; k < 2; ++k) {
          EXPECT_NEAR(around.force[p][k] + around.force[opposite][k], 0, tolerance);
          largest = std::max(largest, std::abs(around.force[p][k]));
        }
        if (!rotating) continue;
        EXPECT_NEAR((around.moment[p] + around.moment[opposite]) / packing.radius[p], 0, tolerance);
      }
      EXPECT_GT(largest, around.scale);
      double moments = 0;
      for (const int corner : frame.corner) {
        moments += around.moment[static_cast<std::size_t>(corner)];
      }
      const auto first = static_cast<std::size_t>(frame.corner[0]);
      EXPECT_NEAR(rotating ? moments / packing.radius[first] : 0, 0, tolerance);
    });
  }
}

TEST(hill_mandel, boundary_particles_average_to_the_deformation) {  // eqs. 1-2
  at_equilibria(describe(small_packing(), rough_law(), BoundaryType::frame_p),
                [](const State& state, const Tensor& F) {
                  const auto& packing = state.material().packing;
                  const auto& frame = *packing.frame;
                  const auto& x = state.current().coordinates;
                  Tensor mean{};
                  for (std::size_t q = 0; q < frame.boundary.size(); ++q) {
                    const auto p = static_cast<std::size_t>(frame.boundary[q]);
                    for (std::size_t i = 0; i < 2; ++i) {
                      for (std::size_t j = 0; j < 2; ++j) {
                        mean[2 * i + j] +=
                            x[i * packing.size() + p] * frame.area[q][j] / polygon_area(packing);
                      }
                    }
                  }
                  EXPECT_LE(relative_difference(mean, F), 1e-13);
                });
}

}  // namespace
}  // namespace grainlaw::core::test
