// A layer of spheres between two walls of symmetry against the discs that it is.
#include "../data.hpp"
#include "sphere_support.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace grainlaw::core::sphere_test {
namespace {

constexpr double tolerance = 1e-11;
constexpr double height = 0.02;  // of the cell of spheres, higher than they are [m]
constexpr double step = 5e-4;
constexpr std::array<std::size_t, 4> in_plane{0, 1, 3, 4};

MaterialDescription discs() {
  const std::string data = grainlaw::test::data_file("rve400_");
  MaterialDescription description;
  description.packing =
      read_packing({data + "particles.csv", data + "contacts.csv", data + "cell.csv"});
  description.law.young = 6e8;
  description.law.ratio = 0.8;
  description.law.friction = std::tan(0.5);
  description.solver.tolerance = tolerance;
  return description;
}

MaterialDescription spheres() {
  MaterialDescription description = discs();
  Packing& packing = description.packing;
  const auto& h = packing.cell;
  packing.dimension = 3;
  packing.position.resize(3 * packing.size(), 0.0);
  packing.cell = {h[0], h[1], 0, h[2], h[3], 0, 0, 0, height};
  return description;
}

Tensor<2> in_steps(double steps) {
  const double e = step * steps;
  return {1 + 0.3 * e, 0.2 * e, 0, 1 - e};
}
Deformation lifted(const Tensor<2>& f) { return {f[0], f[1], 0, f[2], f[3], 0, 0, 0, 1}; }

// The configuration of the layer that has the places, rotations and springs of these discs.
Configuration<3> lifted(const Material<2>& material, const Configuration<2>& from) {
  const std::size_t n = material.packing.size();
  Configuration<3> to;
  to.deformation = lifted(from.deformation);
  to.coordinates.assign(7 * n, 0.0);
  for (std::size_t p = 0; p < n; ++p) {
    for (std::size_t k = 0; k < 2; ++k) to.coordinates[k * n + p] = from.coordinates[k * n + p];
    to.coordinates[3 * n + p] = std::cos(0.5 * from.coordinates[2 * n + p]);
    to.coordinates[6 * n + p] = std::sin(0.5 * from.coordinates[2 * n + p]);
  }
  const auto cell = product<2>(from.deformation, tensor_of<2>(material.packing.cell));
  for (const auto& old : from.contacts) {
    const Vec<2> shift{static_cast<double>(old.shift[0]), static_cast<double>(old.shift[1])};
    const Vec<2> l = branch<2>(from.coordinates.data(), n, static_cast<std::size_t>(old.i),
                               static_cast<std::size_t>(old.j), cell, shift);
    const double scale = old.tangential_force[0] / length<2>(l);
    auto& contact = to.contacts.emplace_back();
    contact.i = old.i;
    contact.j = old.j;
    contact.shift = {old.shift[0], old.shift[1], 0};
    contact.sliding = old.sliding;
    contact.tangential_force = {-scale * l[1], scale * l[0], 0};
  }
  return to;
}

Tensor<2> of_discs(const Deformation& stress, double thickness) {
  Tensor<2> result{};
  for (std::size_t k = 0; k < 4; ++k) result[k] = stress[in_plane[k]] * height / thickness;
  return result;
}

Tensor4<2> of_discs(const Tensor4<3>& tangent, double thickness) {
  Tensor4<2> result{};
  for (std::size_t m = 0; m < 4; ++m) {
    for (std::size_t l = 0; l < 4; ++l) {
      result[4 * m + l] = tangent[9 * in_plane[m] + in_plane[l]] * height / thickness;
    }
  }
  return result;
}

bool same_contacts(const Configuration<2>& discs, const Configuration<3>& spheres) {
  return std::equal(discs.contacts.begin(), discs.contacts.end(), spheres.contacts.begin(),
                    spheres.contacts.end(), [](const auto& a, const auto& b) {
                      return a.i == b.i && a.j == b.j && a.sliding == b.sliding;
                    });
}

// Discs, and a layer that starts every increment from their committed state.
class Pair {
 public:
  struct Difference {
    double stress, tangent;
    bool same_contacts;
  };

  // Evaluates both.
  Difference go_to(const Tensor<2>& f) {
    from_ = lifted(plane_.material(), plane_.committed());
    from_.stress = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (double& component : from_.stress) component *= plane_.committed().stress[0];
    space_.restore(from_);
    Tensor4<2> tangent{};
    grainlaw_report report{};
    EXPECT_EQ(plane_.evaluate(f.data(), TangentKind::exact, stress_.data(), tangent.data(), report),
              GRAINLAW_OK);
    EXPECT_EQ(report.subincrements, 1);
    const auto found = evaluate(space_, lifted(f), TangentKind::exact);
    EXPECT_LT(found.report.residual, tolerance);
    EXPECT_NEAR(found.stress[8], 0, 1e-9 * norm(stress_));
    return {relative_difference(of_discs(found.stress, thickness()), stress_),
            relative_difference(of_discs(found.tangent, thickness()), tangent),
            same_contacts(plane_.current(), space_.current())};
  }
  void commit() { plane_.commit(); }

 private:
  [[nodiscard]] double thickness() const { return plane_.material().packing.thickness; }

  State<2> plane_{make_material<2>(discs())};
  State<3> space_{make_material<3>(spheres())};
  Configuration<3> from_;
  Tensor<2> stress_{};
};

// Tangential displacements of discs and spheres agree to second order in the increment, as long as the
// same contacts touch and slide in both.
TEST(layer_of_spheres, differs_from_discs_in_second_order_unless_other_contacts_touch_or_slide) {
  constexpr int increments = 10;
  constexpr double of_second_order = 10 * step * step, of_tangent = 0.2 * step;
  Pair pair;
  int alike = 0;
  for (int k = 1; k <= increments; ++k) {
    const auto half = pair.go_to(in_steps(k - 0.5));
    const auto whole = pair.go_to(in_steps(k));
    for (const auto& at : {half, whole}) {
      if (!at.same_contacts) continue;
      ++alike;
      EXPECT_LT(at.stress, of_second_order) << k;
      EXPECT_LT(at.tangent, of_tangent) << k;
    }
    if (k == 1) {
      EXPECT_TRUE(half.same_contacts && whole.same_contacts);
      EXPECT_GT(whole.stress, 1e-10);
      EXPECT_LT(half.stress, 0.4 * whole.stress);
      EXPECT_LT(half.tangent, 0.4 * whole.tangent);
    }
    pair.commit();
  }
  EXPECT_GE(alike, increments);
}

// States of their own: a rattler that bears again, and a contact at a change of status, pass on a
// difference that rounding makes.
TEST(layer_of_spheres, parts_from_the_discs_where_rattlers_bear_again_or_contacts_change) {
  State<2> plane(make_material<2>(discs()));
  State<3> space(make_material<3>(spheres()));
  const double thickness = plane.material().packing.thickness;
  double largest = 1e-7;  // of second order in the increment
  for (int k = 1; k <= 50; ++k) {
    const Tensor<2> f = in_steps(k);
    Tensor<2> stress{};
    grainlaw_report report{};
    ASSERT_EQ(plane.evaluate(f.data(), TangentKind::none, stress.data(), nullptr, report),
              GRAINLAW_OK);
    const auto found = evaluate(space, lifted(f));
    plane.commit();
    space.commit();
    const double difference = relative_difference(of_discs(found.stress, thickness), stress);
    const bool may_part = report.rattlers_loaded > 0 || found.report.rattlers_loaded > 0 ||
                          !same_contacts(plane.committed(), space.committed());
    EXPECT_LT(difference, may_part ? 1e-3 : 2 * largest) << k;
    largest = std::max(largest, difference);
  }
}

}  // namespace
}  // namespace grainlaw::core::sphere_test
