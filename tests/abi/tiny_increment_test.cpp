// Increments that change forces by less than the tolerance: their stiffness, and what many of them add up to.
#include "support.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace grainlaw::test {
namespace {

// Discs and spheres, of tests/data.
struct Case {
  const char* dimension;
  const char* packing;
  const char* young;
  std::size_t components;  // of F
};
const std::vector<Case> cases{{"2", "rve400", "6e8", 4}, {"3", "spheres500", "1e8", 9}};

Material make(const Case& of, const std::string& solver) {
  const std::string packing = of.packing;
  return Material::parse(
      "dimension = " + std::string(of.dimension) + "\n[packing]\nparticles = \"" + packing +
          "_particles.csv\"\ncontacts = \"" + packing + "_contacts.csv\"\ncell = \"" + packing +
          "_cell.csv\"\n[contact]\nlaw = \"frictional\"\nyoung = " + of.young +
          "\nratio = 0.8\nfriction = 0.5463\n[solver]\n" + solver,
      data_directory);
}

// F in compression of the last axis at constant volume.
std::vector<double> compressed_by(const Case& of, double strain) {
  const std::size_t d = of.components == 4 ? 2 : 3;
  std::vector<double> F(of.components);
  for (std::size_t k = 0; k < d; ++k)
    F[(d + 1) * k] = std::pow(1 - strain, -1.0 / static_cast<double>(d - 1));
  F.back() = 1 - strain;
  return F;
}

std::vector<double> stress_at(State& state, const Case& of, double strain) {
  std::vector<double> P(of.components);
  grainlaw_report report = grainlaw_report_default();
  const auto F = compressed_by(of, strain);
  EXPECT_EQ(grainlaw_evaluate(state.get(), F.data(), 0, P.data(), nullptr, &report), GRAINLAW_OK)
      << report.message;
  return P;
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> result(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) result[k] = a[k] - b[k];
  return result;
}

double norm(const std::vector<double>& a) {
  double sum = 0;
  for (const double value : a) sum += value * value;
  return std::sqrt(sum);
}

constexpr double start = 1e-3;

// A point at the start of the increments, solved to 1e-11, of a material with another tolerance.
State point_of(const Case& of, const Material& material) {
  State exact(make(of, "tolerance = 1e-11"));
  stress_at(exact, of, start);
  exact.commit();
  State point(material);
  point.load(exact.save());
  return point;
}

TEST(tiny_increments, have_the_stiffness_that_a_tight_tolerance_gives) {
  for (const Case& of : cases) {
    for (const double strain : {1e-6, 1e-8, 1e-10}) {
      State exact = point_of(of, make(of, "tolerance = 1e-11"));
      State coarse = point_of(of, make(of, "tolerance = 1e-4"));
      const auto before = stress_at(exact, of, start);
      const auto right = difference(stress_at(exact, of, start + strain), before);
      const auto found = difference(stress_at(coarse, of, start + strain), before);
      EXPECT_LE(norm(difference(found, right)), 0.05 * norm(right)) << of.packing << ' ' << strain;
    }
  }
}

TEST(tiny_increments, many_add_up_to_one) {
  constexpr double strain = 1e-8;
  constexpr int number = 200;
  for (const Case& of : cases) {
    State exact = point_of(of, make(of, "tolerance = 1e-11"));
    State many = point_of(of, make(of, "tolerance = 1e-4"));
    State one = point_of(of, make(of, "tolerance = 1e-4"));
    const auto before = stress_at(exact, of, start);
    std::vector<double> P;
    for (int k = 1; k <= number; ++k) {
      P = stress_at(many, of, start + k * strain);
      many.commit();
    }
    const auto right = difference(stress_at(exact, of, start + number * strain), before);
    EXPECT_LE(norm(difference(difference(P, before), right)), 0.02 * norm(right)) << of.packing;
    const auto once = stress_at(one, of, start + number * strain);
    EXPECT_LE(norm(difference(P, once)), 1e-4 * norm(once)) << of.packing;
  }
}

TEST(tiny_increments, no_increment_changes_no_stress) {
  for (const Case& of : cases) {
    State point(make(of, "tolerance = 1e-4"));
    const auto before = stress_at(point, of, start);
    point.commit();
    EXPECT_LE(norm(difference(stress_at(point, of, start), before)), 1e-5 * norm(before));
  }
}

}  // namespace
}  // namespace grainlaw::test
