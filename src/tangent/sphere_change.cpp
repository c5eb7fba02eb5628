// Changes of the contacts of spheres.
#include "tangent/contact_change.hpp"

#include "increment/contact_state.hpp"

namespace grainlaw::core {

namespace {

constexpr std::size_t width = Dimension<3>::lanes;
using Lanes = simd::Lanes<width>;
using Triple = std::array<Lanes, 3>;

Lanes load(const ByDeformation<3>& value) { return simd::load<width>(value.lane); }

Triple product(const Matrix3& m, const Triple& a) {
  Triple result;
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = m[3 * k] * a[0] + m[3 * k + 1] * a[1] + m[3 * k + 2] * a[2];
  }
  return result;
}

void add(Triple& a, const Triple& b) {
  for (std::size_t k = 0; k < 3; ++k) a[k] += b[k];
}

struct Change {
  Triple force, spin, branch, spring;
};

// Spins of both particles of a contact.
struct Spins {
  Triple i, j;
};
Spins spins_of(const TouchingContact<3>& contact, const ByDeformation<3>* motion) {
  constexpr std::size_t b = Dimension<3>::unknowns;
  Spins spins;
  for (std::size_t k = 0; k < 3; ++k) {
    spins.i[k] = load(motion[contact.node_i * b + 3 + k]);
    spins.j[k] = load(motion[contact.node_j * b + 3 + k]);
  }
  return spins;
}

struct Loop {
  const Increment<3>& increment;
  Tensor<3> pull_back;
  const DeformationChange<3>& change;
  const HistoryChange<3>& history;
};

// Computes the change of a contact. With `motion` null only affine motion and history count.
Change change_of(const Loop& loop, const TouchingContact<3>& contact,
                 const ByDeformation<3>* motion) {
  constexpr std::size_t b = Dimension<3>::unknowns;
  const auto& list = loop.increment.contacts();
  const auto& law = *loop.increment.problem().law;
  const auto& s = contact.stiffness;
  const Vec<3> reference = grainlaw::core::product<3>(loop.pull_back, contact.point.branch);
  Change result{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t m = 0; m < 3; ++m) {
      result.branch[k] += load(loop.change[3 * k + m]) * reference[m];
    }
  }
  Triple rotation{};
  if (motion != nullptr) {
    const auto* zi = motion + contact.node_i * b;
    const auto* zj = motion + contact.node_j * b;
    Spins spins = spins_of(contact, motion);
    for (std::size_t k = 0; k < 3; ++k) {
      result.branch[k] += load(zj[k]) - load(zi[k]);
      spins.i[k] *= contact.lever_i;
      spins.j[k] *= 1 - contact.lever_i;
    }
    rotation = product(contact.point.spin_i, spins.i);
    add(rotation, product(contact.point.spin_j, spins.j));
  }
  result.force = product(s.force_by_branch, result.branch);
  result.spin = product(s.spin_by_branch, result.branch);
  if (motion != nullptr) {
    add(result.force, product(s.force_by_rotation, rotation));
    add(result.spin, product(s.spin_by_rotation, rotation));
  }
  Triple by_history{};
  if (loop.history.normal != nullptr && law.tangential()) {
    const double overlap = list.rest_of(contact.index) - contact.point.distance;
    const double scale = start_scale(overlap, law);
    const double kt_d = list.tangential_stiffness[contact.index] * stiffness_scale(overlap, law) *
                        contact.point.distance;
    Triple start;
    for (std::size_t k = 0; k < 3; ++k) {
      start[k] = scale * load(loop.history.force[contact.index][k]) +
                 kt_d * load(loop.history.normal[contact.index][k]);
    }
    by_history = product(s.spring_by_start, start);
    add(result.force, by_history);
    if (law.rotating()) {
      Matrix3 lever{};
      grainlaw::core::add(lever, -list.inverse_reach[contact.index],
                          cross_matrix(contact.point.branch));
      add(result.spin, product(lever, by_history));
    }
  }
  // The change of the tangential force is that of the force less the normal part by kn and fn.
  const auto& n = contact.point.normal;
  Lanes along{};
  for (std::size_t k = 0; k < 3; ++k) along += n[k] * result.branch[k];
  const double by_distance = contact.point.normal_force / contact.point.distance;
  const double kn = list.normal_stiffness[contact.index] *
                    stiffness_scale(list.rest_of(contact.index) - contact.point.distance, law);
  for (std::size_t k = 0; k < 3; ++k) {
    result.spring[k] =
        result.force[k] + (kn + by_distance) * n[k] * along - by_distance * result.branch[k];
  }
  return result;
}

// Change of the moment on j that belongs to the change of the contact.
Triple moment_change_of(const Loop& loop, const TouchingContact<3>& contact,
                        const ContactMoment<3>& moment, const Triple& branch,
                        const ByDeformation<3>* motion) {
  Triple result = product(moment.by_branch, branch);
  if (motion != nullptr) {
    const Spins spins = spins_of(contact, motion);
    add(result, product(moment.by_spin_i, spins.i));
    add(result, product(moment.by_spin_j, spins.j));
  }
  if (loop.history.moment == nullptr) return result;
  const auto& list = loop.increment.contacts();
  const double scale = start_scale(list.rest_of(contact.index) - contact.point.distance,
                                   *loop.increment.problem().law);
  Triple start;
  for (std::size_t k = 0; k < 3; ++k) {
    start[k] = scale * load(loop.history.moment[contact.index][k]);
  }
  add(result, product(moment.by_start, start));
  return result;
}

Loop loop_of(const Increment<3>& increment, const DeformationChange<3>& change,
             const HistoryChange<3>& history) {
  return {increment, inverse<3>(increment.motion().deformation()), change, history};
}

Triple product(const DeformationChange<3>& m, const Vec<3>& a) {
  Triple result{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t l = 0; l < 3; ++l) result[k] += load(m[3 * k + l]) * a[l];
  }
  return result;
}

Triple cross(const Triple& a, const Vec<3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Triple cross(const Vec<3>& a, const Triple& b) {
  const Triple opposite = cross(b, a);
  return {-opposite[0], -opposite[1], -opposite[2]};
}

Lanes dot(const Vec<3>& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Change of the excess of a two-contact sphere over its rule.
Lanes excess_change(const Loop& loop, const TwoContactSpheres::TwoContactSphere& sphere) {
  const auto& motion = loop.increment.motion();
  if (sphere.stopped()) {
    const Vec<3> branch = branch_of(loop.increment, sphere.third);
    return sphere.third_side *
           dot(sphere.by_third,
               product(loop.change, grainlaw::core::product<3>(loop.pull_back, branch)));
  }
  Lanes result =
      dot(sphere.way,
          product(loop.change, grainlaw::core::product<3>(loop.pull_back, sphere.departure)));
  if (loop.history.normal == nullptr) return result;
  constexpr std::size_t b = Dimension<3>::unknowns;
  const std::size_t n = loop.increment.problem().nodes();
  const double* rotation = motion.coordinates().data() + 3 * n + sphere.node;
  const Vec<3> spin{rotation[0], rotation[n], rotation[2 * n]};
  std::array<Triple, 2> outward;
  Triple departure{};  // of the affinely moved start
  Vec<3> point{};
  const auto carried =
      grainlaw::core::product<3>(motion.deformation(), inverse<3>(motion.start_deformation()));
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t c = sphere.contact[k];
    for (std::size_t m = 0; m < 3; ++m) {
      outward[k][m] = sphere.side[k] * load(loop.history.normal[c][m]);
      departure[m] += 0.5 * (load(loop.history.motion[sphere.node * b + m]) -
                             load(loop.history.motion[sphere.neighbour[k] * b + m]));
      if (k == 0) point[m] = sphere.side[k] * loop.increment.contacts().start_normal[m][c];
    }
  }
  Triple chord;
  for (std::size_t m = 0; m < 3; ++m) chord[m] = outward[1][m] - outward[0][m];
  Triple way = cross(chord, point);
  add(way, cross(sphere.chord, outward[0]));
  const double scale = sphere.way_scale;
  result += dot(spin, chord) + scale * dot(sphere.departure, way) +
            dot(sphere.way, product(carried, departure));
  return result;
}

void put(const Triple& from, std::array<ByDeformation<3>, 3>& to) {
  for (std::size_t k = 0; k < 3; ++k) simd::store(to[k].lane, from[k]);
}

}  // namespace

template <>
void add_residual_changes<3>(const Increment<3>& increment, const Stiffness<3>& stiffness,
                             const DeformationChange<3>& change, const HistoryChange<3>& history,
                             std::span<ByDeformation<3>> residual) {
  constexpr std::size_t b = Dimension<3>::unknowns;
  const Loop loop = loop_of(increment, change, history);
  const bool rotating = increment.problem().law->rotating();
  const auto moments = stiffness.moments();
  for (std::size_t c = 0; c < stiffness.touching().size(); ++c) {
    const auto& contact = stiffness.touching()[c];
    const Change found = change_of(loop, contact, nullptr);
    const double radius_i = contact.lever_i * contact.reach;
    const double radius_j = contact.reach - radius_i;
    const auto add_to = [&](std::size_t node, std::size_t k, const Lanes& value) {
      double* const at = residual[node * b + k].lane;
      simd::store(at, simd::load<width>(at) + value);
    };
    for (std::size_t k = 0; k < 3; ++k) {
      add_to(contact.node_i, k, -found.force[k]);
      add_to(contact.node_j, k, found.force[k]);
      if (!rotating) continue;
      add_to(contact.node_i, 3 + k, radius_i * found.spin[k]);
      add_to(contact.node_j, 3 + k, radius_j * found.spin[k]);
    }
    if (moments.empty()) continue;
    const Triple moment = moment_change_of(loop, contact, moments[c], found.branch, nullptr);
    for (std::size_t k = 0; k < 3; ++k) {
      add_to(contact.node_i, 3 + k, -moment[k]);
      add_to(contact.node_j, 3 + k, moment[k]);
    }
  }
  for (const auto& sphere : increment.two_contact_spheres().spheres()) {
    const Lanes excess = excess_change(loop, sphere);
    for (std::size_t k = 0; k < 3; ++k) {
      double* const at = residual[sphere.node * b + 3 + k].lane;
      simd::store(at, simd::load<width>(at) - sphere.stiffness * sphere.chord[k] * excess);
    }
  }
}

template <>
void find_contact_changes<3>(const Increment<3>& increment,
                             std::span<const TouchingContact<3>> touching,
                             const DeformationChange<3>& change, const HistoryChange<3>& history,
                             std::span<const ByDeformation<3>> motion,
                             std::span<ContactChange<3>> changes) {
  const Loop loop = loop_of(increment, change, history);
  for (std::size_t c = 0; c < touching.size(); ++c) {
    const Change found = change_of(loop, touching[c], motion.data());
    put(found.force, changes[c].force);
    put(found.branch, changes[c].branch);
    put(found.spring, changes[c].tangential_force);
  }
}

template <>
void find_moment_changes<3>(const Increment<3>& increment, const Stiffness<3>& stiffness,
                            const DeformationChange<3>& change, const HistoryChange<3>& history,
                            std::span<const ByDeformation<3>> motion,
                            std::span<ByDeformation<3>> changes) {
  const Loop loop = loop_of(increment, change, history);
  const auto touching = stiffness.touching();
  for (std::size_t c = 0; c < touching.size(); ++c) {
    const Triple branch = change_of(loop, touching[c], motion.data()).branch;
    const Triple moment =
        moment_change_of(loop, touching[c], stiffness.moments()[c], branch, motion.data());
    for (std::size_t k = 0; k < 3; ++k) simd::store(changes[3 * c + k].lane, moment[k]);
  }
}

}  // namespace grainlaw::core
