// The stiffness of a contact is the derivative of its law, in every status.
#include "contact_support.hpp"
#include "tangent/stiffness.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace grainlaw::core::test {
namespace {

constexpr double kn = 1000;
constexpr double kt = 800;
constexpr std::array<double, 4> cell{10, 0, 0, 10};
using Matrix3 = std::array<double, 9>;

ContactLaw law() {
  ContactLaw law;
  law.normal_stiffness = kn;
  law.ratio = kt / kn;
  law.friction = 0.5;
  return law;
}

const std::vector<double> radius{1, 3};

// Radii 1 and 3 on an oblique branch, turned and moved from where the history started.
struct Contact {
  ContactList list;
  std::vector<double> z;

  Contact(double committed_force, double overlap, double turn) {
    const std::vector<double> start{0, 3.1, 0, 2.3, 0.2, -0.1};
    const std::vector<NeighbourPair> pairs{{0, 1, {}}};
    const std::vector<ContactHistory> history{{0, 1, {}, false, false, {committed_force}}};
    test::build(pairs, radius, law(), cell, {start, cell, history}, list);
    const double angle = std::atan2(2.3, 3.1) + turn;
    z = {0.1,   0.1 + (4 - overlap) * std::cos(angle),
         -0.2,  -0.2 + (4 - overlap) * std::sin(angle),
         0.205, -0.103};
  }
  [[nodiscard]] ContactPoint point() const { return contact_point(list, 0, z, 2, law()); }
  [[nodiscard]] Matrix3 stiffness() const {
    return contact_stiffness(point(), kn, kt, law().friction);
  }
};

struct Forces {
  double x, y, couple;
};

Forces forces(Contact contact) {
  test::forces(contact.z, radius, law(), contact.list);
  const ForceRecord& on_j = contact.list.forces[0];
  return {on_j.x, on_j.y, -on_j.roll * contact.list.reach[0]};
}

// Central differences of (force along n, force along t, couple) by (normal displacement, tangential
// displacement, weighted rotation), n and t held where they are.
Matrix3 differences(const Contact& contact, double step) {
  const auto at = contact.point();
  const auto moved = [&](std::size_t column, double by) {
    Contact other = contact;
    if (column == 0) {
      other.z[1] += by * at.normal[0];
      other.z[3] += by * at.normal[1];
    } else if (column == 1) {
      other.z[1] -= by * at.normal[1];
      other.z[3] += by * at.normal[0];
    } else {
      other.z[5] += by / 0.75;  // lambda_j
    }
    const Forces f = forces(other);
    return std::array{f.x * at.normal[0] + f.y * at.normal[1],
                      -f.x * at.normal[1] + f.y * at.normal[0], f.couple};
  };
  Matrix3 result{};
  for (std::size_t column = 0; column < 3; ++column) {
    const auto plus = moved(column, step);
    const auto minus = moved(column, -step);
    for (std::size_t row = 0; row < 3; ++row) {
      result[3 * row + column] = (plus[row] - minus[row]) / (2 * step);
    }
  }
  return result;
}

struct Case {
  const char* name;
  Contact contact;
  ContactStatus status;
};

std::vector<Case> cases() {
  return {{"sticking", {0, 0.1, 0.002}, ContactStatus::sticking},
          {"sticking with a committed force", {30, 0.12, 0.004}, ContactStatus::sticking},
          {"sliding forwards", {30, 0.1, -0.05}, ContactStatus::sliding},
          {"sliding backwards", {-20, 0.15, 0.08}, ContactStatus::sliding},
          {"deep, hardly turned", {5, 0.5, 1e-6}, ContactStatus::sticking}};
}

TEST(contact_stiffness, matches_central_differences_of_the_law) {
  for (const Case& c : cases()) {
    ASSERT_EQ(c.contact.point().status, c.status) << c.name;
    ASSERT_NE(c.contact.point().slip_angle, 0);
    const Matrix3 exact = c.contact.stiffness();
    const Matrix3 approximate = differences(c.contact, 1e-6);
    for (std::size_t k = 0; k < 9; ++k) {
      EXPECT_NEAR(exact[k], approximate[k], 1e-8 * kn * 16) << c.name << ", entry " << k;
    }
  }
}

TEST(contact_stiffness, is_zero_when_open) {
  const Contact open(30, -0.1, 0.01);
  EXPECT_EQ(open.point().status, ContactStatus::open);
  for (const double entry : differences(open, 1e-6)) EXPECT_EQ(entry, 0);
}

}  // namespace
}  // namespace grainlaw::core::test
