// A few discs in a wide cell, moved by hand.
#pragma once

#include "contact_support.hpp"

#include "contact/law.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace grainlaw::core::test {

inline constexpr std::array<double, 4> cell{10, 0, 0, 10};

// Discs whose contacts are listed once, all pairs in order; coordinates component-major.
struct Discs {
  ContactLaw law;
  std::vector<double> radius;
  std::vector<double> start;
  std::vector<double> z;
  ContactList list;
  std::vector<double> force;

  Discs(const ContactLaw& contact_law, std::vector<double> radii, std::vector<double> coordinates,
        std::vector<ContactHistory> history = {}, std::vector<NeighbourPair> pairs = {{0, 1, {}}},
        std::vector<double> moments = {}, std::vector<double> gaps = {})
      : law(contact_law), radius(std::move(radii)), start(std::move(coordinates)), z(start) {
    test::build(pairs, radius, law, cell, {start, cell, history, moments, gaps}, list);
    force.resize(z.size());
  }
  [[nodiscard]] std::size_t size() const { return radius.size(); }
  double& x(std::size_t p) { return z[p]; }
  double& y(std::size_t p) { return z[size() + p]; }
  double& turn(std::size_t p) { return z[2 * size() + p]; }

  void evaluate() { force = test::forces(z, radius, law, list); }
  double advance() {
    std::vector<ForceRecord> sums(size());
    return advance_contacts<2>(test::records(z, radius), law, list, sums);
  }
  [[nodiscard]] double energy() const { return stored_energy(list, z, size(), law); }
  [[nodiscard]] double moment(std::size_t c = 0) const {
    return contact_moment(list, c, point(c), z, size(), law).moment;
  }
  [[nodiscard]] ContactPoint point(std::size_t c = 0) const {
    return contact_point(list, c, z, size(), law);
  }
};

// Turn everything about the origin.
inline void rotate(Discs& discs, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  for (std::size_t p = 0; p < discs.size(); ++p) {
    const double x = discs.x(p);
    const double y = discs.y(p);
    discs.x(p) = c * x - s * y;
    discs.y(p) = s * x + c * y;
    if (discs.law.rotating()) discs.turn(p) += angle;
  }
}

}  // namespace grainlaw::core::test
