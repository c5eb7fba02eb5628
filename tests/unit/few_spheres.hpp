// A few spheres whose contacts are listed once, for closed forms.
#pragma once

#include "contact/contact_forces.hpp"
#include "contact/contact_point.hpp"
#include "increment/records.hpp"

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace grainlaw::core::sphere_test {

// Bonded where the law has bonds; coordinates component-major: places, Gibbs vectors.
struct Spheres {
  ContactLaw law;
  std::vector<double> radius;
  std::vector<double> z;
  ContactList<3> list;

  Spheres(const ContactLaw& contact_law, std::vector<double> radii, std::vector<double> places,
          const std::vector<NeighbourPair<3>>& pairs = {{0, 1, {}}})
      : law(contact_law), radius(std::move(radii)), z(std::move(places)) {
    z.resize(6 * radius.size(), 0.0);
    std::vector<int> node(radius.size());
    std::iota(node.begin(), node.end(), 0);
    std::vector<ContactHistory<3>> history;
    for (const auto& pair : pairs) {
      auto& contact = history.emplace_back();
      contact.i = pair.i;
      contact.j = pair.j;
      contact.bonded = law.bonds();
    }
    const Tensor<3> cell{10, 0, 0, 0, 10, 0, 0, 0, 10};
    build_contacts<3>(pairs, {}, radius, node, radius.size(), law, cell, {z, cell, history}, list);
  }

  // Force and spin moment over radius on every sphere.
  std::vector<ForceRecord<3>> forces() {
    std::vector<ParticleRecord<3>> records(radius.size());
    for (std::size_t p = 0; p < radius.size(); ++p) records[p].radius = radius[p];
    load_records(z.data(), law.rotating(), records);
    std::vector<ForceRecord<3>> sums(radius.size());
    evaluate_contacts<3>(records, law, list, sums);
    return sums;
  }
  ContactPoint<3> point(std::size_t c = 0) const {
    return contact_point(list, c, z, radius.size(), law);
  }
  ContactMoment<3> moment(std::size_t c = 0) const {
    return contact_moment(list, c, point(c), z, radius.size(), law);
  }
  // A sphere turned by an angle about an axis [rad].
  void turn(std::size_t sphere, const Vec<3>& axis, double angle) {
    for (std::size_t k = 0; k < 3; ++k) {
      z[(3 + k) * radius.size() + sphere] = 2 * std::tan(0.5 * angle) * axis[k];
    }
  }
};

}  // namespace grainlaw::core::sphere_test
