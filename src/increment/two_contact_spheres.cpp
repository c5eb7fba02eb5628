#include "increment/two_contact_spheres.hpp"

#include "base/capacity.hpp"
#include "base/constants.hpp"
#include "increment/contact_state.hpp"
#include "packing/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw::core {

namespace {

constexpr unsigned char two = 2, more = 3;
constexpr double unlimited = std::numeric_limits<double>::infinity();

// Side of the node in the contact (1: first, -1: second), and the other node.
struct End {
  double side;
  std::size_t neighbour;
};
End end_of(const ForceBalance<3>& balance, std::size_t c, std::size_t q) {
  const auto& node = balance.problem().space->node;
  const auto node_of = [&](const auto& ends) {
    return static_cast<std::size_t>(node[static_cast<std::size_t>(ends[c])]);
  };
  const std::size_t i = node_of(balance.contacts().i);
  const std::size_t j = node_of(balance.contacts().j);
  return i == q ? End{1, j} : End{-1, i};
}

}  // namespace

bool TwoContactSpheres::possible(const ForceBalance<3>& balance) {
  const ContactLaw& law = *balance.problem().law;
  const bool by_moments = law.rolls() || (law.moments() && law.bond.bending_stiffness > 0);
  return law.rotating() && law.tangential() && !by_moments && !balance.motion().drag().acts();
}

void TwoContactSpheres::find(const ForceBalance<3>& balance) {
  const auto& list = balance.contacts();
  const auto& node = balance.problem().space->node;
  const std::size_t n = balance.problem().nodes();
  resize_with_capacity(count_, n);
  resize_with_capacity(contact_, n);
  resize_with_capacity(index_, n);
  std::fill(count_.begin(), count_.end(), static_cast<unsigned char>(0));
  const auto& scale = balance.scale();
  const double least = std::min(tuned::more_than_chance * scale.chance(),
                                tuned::least_supporting_force * scale.relative());
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (surely_open(balance, c)) continue;
    const double force = normal_force(list, c, overlap_of(balance, c), *balance.problem().law);
    if (!list.bonded(c) && force <= least) continue;
    for (const auto p : {list.i[c], list.j[c]}) {
      const auto q = static_cast<std::size_t>(node[static_cast<std::size_t>(p)]);
      if (count_[q] < two) contact_[q][count_[q]] = c;
      if (count_[q] < more) ++count_[q];
    }
  }
  reserve_with_capacity(spheres_, n);
  forget();
  for (std::size_t q = 0; q < n; ++q) {
    index_[q] = none;
    if (count_[q] != two) continue;
    const TwoContactSphere sphere = sphere_at(balance, q);
    if (!(sphere.stiffness < unlimited)) continue;  // both contacts in one direction: no chord
    index_[q] = spheres_.size();
    spheres_.push_back(sphere);
  }
  if (spheres_.empty()) return;
  find_limits(balance);
  stop(balance);
}

TwoContactSpheres::TwoContactSphere TwoContactSpheres::sphere_at(const ForceBalance<3>& balance,
                                                                 std::size_t q) const {
  const auto& list = balance.contacts();
  const auto& motion = balance.motion();
  const std::size_t n = balance.problem().nodes();
  const double radius = motion.node_radius()[q];
  const auto carried = product<3>(motion.deformation(), inverse<3>(motion.start_deformation()));
  const double* rotation = motion.coordinates().data() + 3 * n;
  const Vec<3> spin{rotation[q], rotation[n + q], rotation[2 * n + q]};
  TwoContactSphere sphere{};
  sphere.node = q;
  sphere.contact = contact_[q];
  Vec<3> point{};  // first contact point, over the radius
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t c = sphere.contact[k];
    const auto [side, neighbour] = end_of(balance, c, q);
    sphere.side[k] = side;
    sphere.neighbour[k] = neighbour;
    const Vec<3> shift{list.shift[0][c], list.shift[1][c], list.shift[2][c]};
    const Vec<3> start =
        branch<3>(motion.start().data(), n, static_cast<std::size_t>(list.i[c]),
                  static_cast<std::size_t>(list.j[c]), motion.start_deformation(),
                  product<3>(tensor_of<3>(balance.problem().packing->cell), shift));
    const Vec<3> now = branch_of(balance, c);
    const Vec<3> departure = sum(now, -1, product<3>(carried, start));
    for (std::size_t m = 0; m < 3; ++m) {
      const double outward = sphere.side[k] * list.start_normal[m][c];
      sphere.chord[m] += k == 0 ? -outward : outward;
      if (k == 0) point[m] = outward;
      sphere.departure[m] += 0.5 * sphere.side[k] * departure[m];
    }
  }
  // Ratio of the masses in a relaxation of spheres.
  const double inertia = 2 * balance.problem().law->ratio;
  sphere.way_scale = 1 / (inertia * radius);
  sphere.way = sum({}, sphere.way_scale, cross(sphere.chord, point));
  sphere.by_spin = sum(sphere.chord, 0.5, cross(spin, sphere.chord));
  sphere.excess = dot(sphere.chord, spin) + dot(sphere.way, sphere.departure);
  sphere.stiffness =
      tuned::chord_spring * balance.masses().of_unknowns()[3 * n + q] / square<3>(sphere.chord);
  return sphere;
}

void TwoContactSpheres::find_limits(const ForceBalance<3>& balance) {
  const auto& list = balance.contacts();
  const auto& node = balance.problem().space->node;
  reserve_with_capacity(limits_, index_.size());
  limits_.assign(spheres_.size(), {Limit{unlimited, none, {}}, Limit{unlimited, none, {}}});
  for (std::size_t c = 0; c < list.size(); ++c) {
    const auto i = static_cast<std::size_t>(node[static_cast<std::size_t>(list.i[c])]);
    const auto j = static_cast<std::size_t>(node[static_cast<std::size_t>(list.j[c])]);
    if (i == j) continue;
    if (index_[i] != none) limit_by_third(balance, c, index_[i], 1);
    if (index_[j] != none) limit_by_third(balance, c, index_[j], -1);
  }
}

// Finds how far the sphere may roll until contact c closes, to first order.
void TwoContactSpheres::limit_by_third(const ForceBalance<3>& balance, std::size_t c,
                                       std::size_t index, double side) {
  const TwoContactSphere& sphere = spheres_[index];
  if (c == sphere.contact[0] || c == sphere.contact[1]) return;
  const auto& list = balance.contacts();
  const auto& motion = balance.motion();
  const Vec<3> branch = branch_of(balance, c);
  const double distance = length<3>(branch);
  const double radius = motion.node_radius()[sphere.node];
  const Vec<3> outward = sum({}, side / distance, branch);
  // Derivatives for a rotation of length chord about the chord: of the distance, and of the excess.
  const Vec<3> moved = sum({}, radius / sphere.way_scale, sphere.way);
  const double opening = dot(outward, moved);
  if (std::abs(opening) < tuned::least_closing * length<3>(moved)) return;
  const double excess_rate = square<3>(sphere.chord) + dot(sphere.way, moved);
  const double scale = excess_rate / opening;
  const double room = std::abs(scale) * (distance - list.reach[c]);
  Limit& limit = limits_[index][opening > 0 ? 0 : 1];
  if (room < limit.room) limit = {room, c, sum({}, scale, outward)};
}

// Reduces positive excess to zero or to its lower limit, raises negative excess likewise.
void TwoContactSpheres::stop(const ForceBalance<3>& balance) {
  for (std::size_t k = 0; k < spheres_.size(); ++k) {
    TwoContactSphere& sphere = spheres_[k];
    const auto& [down, up] = limits_[k];
    const Limit* limit = nullptr;
    if (sphere.excess > down.room) {
      limit = &down;
    } else if (sphere.excess < -up.room) {
      limit = &up;
    }
    if (limit == nullptr) continue;
    sphere.excess = limit == &down ? down.room : -up.room;
    sphere.third = limit->contact;
    sphere.by_third = limit->by_branch;
    const auto [side, neighbour] = end_of(balance, sphere.third, sphere.node);
    sphere.third_side = side;
    sphere.third_neighbour = neighbour;
    arbitrary_ = arbitrary_ || count_[neighbour] < two;
  }
  arbitrary_ = arbitrary_ || std::ranges::any_of(spheres_, [this](const TwoContactSphere& sphere) {
                 return sphere.stopped() && stops_itself(sphere);
               });
}

// True where those that stop this sphere, one after the other, lead back to it.
bool TwoContactSpheres::stops_itself(const TwoContactSphere& sphere) const {
  std::size_t node = sphere.third_neighbour;
  for (std::size_t k = 0; k < spheres_.size() && node != sphere.node; ++k) {
    if (index_[node] == none || !spheres_[index_[node]].stopped()) return false;
    node = spheres_[index_[node]].third_neighbour;
  }
  return node == sphere.node;
}

void TwoContactSpheres::add_to(std::size_t nodes, std::span<double> residual) const {
  for (const TwoContactSphere& sphere : spheres_) {
    for (std::size_t k = 0; k < 3; ++k) {
      residual[(3 + k) * nodes + sphere.node] -= sphere.stiffness * sphere.excess * sphere.chord[k];
    }
  }
}

}  // namespace grainlaw::core
