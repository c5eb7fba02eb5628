#include "dynamics/motion.hpp"

#include "base/error.hpp"
#include "contact/contact_forces.hpp"
#include "contact/contact_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainlaw::core {

namespace {

using Force = ForceRecord<2>;

constexpr double gap_in_radii = 0.5;  // so wide that a passing wave seldom renews the list

}  // namespace

WaveMotion::WaveMotion(const WaveSpecimen& specimen, const ContactLaw& law, double time_step)
    : specimen_(&specimen),
      law_(law),
      time_step_(time_step),
      gap_(gap_in_radii * specimen.mean_radius()),
      history_(specimen.contacts),
      moments_(specimen.moments),
      gaps_(specimen.gaps) {
  const std::size_t n = specimen.size();
  particles_.resize(n);
  listed_.resize(n);
  forces_.resize(specimen.nodes);
  velocity_.resize(specimen.nodes);
  inverse_mass_.resize(specimen.nodes);
  mass_.resize(specimen.nodes);
  particle_of_.resize(specimen.nodes);
  for (std::size_t p = n; p-- > 0;) {
    mass_[node(p)] += specimen.mass[p];
    particle_of_[node(p)] = p;
  }
  for (std::size_t p = 0; p < n; ++p) {
    particles_[p] = {specimen.position[p], specimen.position[n + p], 0, specimen.radius[p]};
    const auto by_mass = [&](Support direction) {
      return (specimen.supported[p] & direction) == 0 ? 1 / mass_[node(p)] : 0;
    };
    // The moment of inertia is M R^2 / 2.
    inverse_mass_[node(p)] = {by_mass(support_x), by_mass(support_y),
                              law.rotating() ? 2 * by_mass(support_rotation) : 0, 0};
    if (specimen.right[p]) right_.push_back(p);
    rest_.push_back(specimen.position[p]);
  }
  list_contacts();
  find_forces();
  find_largest_time_step();
  constexpr double rounded_down = 0.995;  // three digits of it are not above the limit
  if (time_step > largest_time_step_)
    throw Error(GRAINLAW_BAD_ARGUMENT,
                fmt::format("time_step: found {:.3g} s, expected at most {:.3g} s, beyond which "
                            "the particles' motion may be unstable",
                            time_step, rounded_down * largest_time_step_));
}

std::vector<double> WaveMotion::coordinates() const {
  const std::size_t n = particles_.size();
  std::vector<double> z(law_.rotating() ? 3 * n : 2 * n);
  for (std::size_t p = 0; p < n; ++p) {
    z[p] = particles_[p].x;
    z[n + p] = particles_[p].y;
    if (law_.rotating()) z[2 * n + p] = particles_[p].roll / particles_[p].radius;
  }
  return z;
}

void WaveMotion::list_contacts() {
  const std::size_t n = particles_.size();
  const std::vector<double> z = coordinates();
  for (std::size_t p = 0; p < n; ++p) listed_[p] = {z[p], z[n + p]};
  search_.find(n, z.data(), specimen_->radius.data(), nullptr, gap_, pairs_);
  if (law_.bonds()) {  // bonds bear at any distance
    const auto before = [](const auto& a, const auto& b) {
      return std::tie(a.i, a.j) < std::tie(b.i, b.j);
    };
    const auto found = pairs_.size();
    for (const ContactHistory<2>& contact : history_) {
      const NeighbourPair<2> pair{contact.i, contact.j, {}};
      const auto end = pairs_.begin() + static_cast<std::ptrdiff_t>(found);
      if (contact.bonded && !std::binary_search(pairs_.begin(), end, pair, before))
        pairs_.push_back(pair);
    }
    std::sort(pairs_.begin(), pairs_.end(), before);
  }
  weights_.clear();
  if (specimen_->shared)
    for (const auto& pair : pairs_)
      weights_.push_back(
          specimen_->weight(static_cast<std::size_t>(pair.i), static_cast<std::size_t>(pair.j)));
  build_contacts<2>(pairs_, weights_, specimen_->radius, specimen_->node, specimen_->nodes, law_,
                    {}, {z, {}, history_, moments_, gaps_}, list_);
}

void WaveMotion::keep_list() {
  double largest = 0;
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const double dx = particles_[p].x - listed_[p][0], dy = particles_[p].y - listed_[p][1];
    largest = std::max(largest, dx * dx + dy * dy);
  }
  if (!std::isfinite(largest))
    throw Error(GRAINLAW_NOT_CONVERGED,
                "a particle has left all bounds; try a smaller pulse.amplitude");
  if (4 * largest <= gap_ * gap_) return;
  // The new list's contacts start with the present history.
  history_.clear();
  moments_.clear();
  const bool keeps_gaps = !gaps_.empty();
  gaps_.clear();
  for (std::size_t c = 0; c < list_.size(); ++c) {
    const bool bonded = list_.bonded(c);
    const double weight = list_.weight_of(c);
    const double moment = list_.start_moment[0].empty() ? 0 : list_.start_moment[0][c];
    if (!bonded && list_.start_force[0][c] == 0 && moment == 0) continue;
    history_.push_back(
        {list_.i[c], list_.j[c], {}, false, bonded, {list_.start_force[0][c] / weight}});
    if (law_.moments()) moments_.push_back(moment / weight);
    if (keeps_gaps) gaps_.push_back(list_.rest_of(c) - list_.reach[c]);
  }
  list_contacts();
}

void WaveMotion::find_forces() {
  dissipated_ += advance_contacts<2>(particles_, law_, list_, forces_);
  if (law_.bonds()) break_bonds();
}

// Breaks bonds beyond their capacity at the present positions, and computes the forces again.
void WaveMotion::break_bonds() {
  const Bond& bond = law_.bond;
  std::vector<std::size_t> broken;
  for (std::size_t c = 0; c < list_.size(); ++c) {
    if (!list_.bonded(c)) continue;
    const Force& f = list_.forces[c];
    const double fn = f.x * list_.start_normal[0][c] + f.y * list_.start_normal[1][c];
    double share =
        -fn / bond.normal_strength + std::abs(list_.start_force[0][c]) / bond.tangential_strength;
    if (law_.moments() && bond.bending_strength > 0)
      share += std::abs(list_.start_moment[0][c]) / bond.bending_strength;
    if (share >= list_.weight_of(c)) broken.push_back(c);
  }
  if (broken.empty()) return;
  const std::vector<double> z = coordinates();
  const double before = stored_energy(list_, z, particles_.size(), law_);
  for (const std::size_t c : broken) {
    const double r_i = specimen_->radius[static_cast<std::size_t>(list_.i[c])];
    const double r_j = specimen_->radius[static_cast<std::size_t>(list_.j[c])];
    list_.bond_capacity[c] = 0;
    list_.rest[c] = list_.reach[c];
    list_.normal_stiffness[c] = list_.weight_of(c) * law_.coefficient(r_i, r_j);
    list_.tangential_stiffness[c] = law_.ratio * list_.normal_stiffness[c];
    if (law_.moments()) {
      list_.bending_stiffness[c] = list_.tangential_stiffness[c] * law_.rolling_ratio(r_i, r_j);
      if (list_.bending_stiffness[c] == 0) list_.start_moment[0][c] = 0;
    }
  }
  advance_contacts<2>(particles_, law_, list_, forces_);
  dissipated_ += before - stored_energy(list_, z, particles_.size(), law_);
}

void WaveMotion::settle() {
  constexpr long most_steps = 50000;
  // Tolerance: a thousandth of the forces at a strain of 1 %.
  const double r = specimen_->mean_radius();
  const double rest = 1e-5 * law_.of_bonds().stiffness(r, r) * r;
  double largest = 0;
  for (long step = 0; step < most_steps; ++step) {
    largest = 0;
    for (std::size_t q = 0; q < velocity_.size(); ++q) {
      const Force &f = forces_[q], &w = inverse_mass_[q];
      Force& v = velocity_[q];
      // Zeroes the velocity of what moves against its force.
      const auto accelerate = [&](double& velocity, double force, double by_mass) {
        if (by_mass == 0) return;
        largest = std::max(largest, std::abs(force));
        velocity = (velocity * force < 0 ? 0 : velocity) + time_step_ * by_mass * force;
      };
      accelerate(v.x, f.x, w.x);
      accelerate(v.y, f.y, w.y);
      accelerate(v.roll, f.roll, w.roll);
    }
    move_particles();
    if (largest <= rest) break;
    keep_list();
    find_forces();
  }
  if (largest > rest)
    throw Error(
        GRAINLAW_NOT_CONVERGED,
        fmt::format("the specimen did not come to rest before the wave: an unbalanced force of "
                    "{:.3g} N is left after {} steps, expected at most {:.3g} N; try a longer "
                    "time_step",
                    largest, most_steps, rest));
  std::fill(velocity_.begin(), velocity_.end(), Force{});
  for (std::size_t p = 0; p < particles_.size(); ++p) rest_[p] = particles_[p].x;
  dissipated_ = 0;
}

void WaveMotion::step(double end_displacement) {
  const double dt = time_step_;
  for (std::size_t q = 0; q < velocity_.size(); ++q) {
    Force& v = velocity_[q];
    const Force &f = forces_[q], &w = inverse_mass_[q];
    v.x += dt * w.x * f.x;
    v.y += dt * w.y * f.y;
    v.roll += dt * w.roll * f.roll;
  }
  if (damping_.rate > 0) damp_agitation();
  move_particles();
  const double moved = end_displacement - end_;
  end_ = end_displacement;
  double force = -force_on_right_end();
  for (const std::size_t p : right_) {
    particles_[p].x = rest_[p] + end_;
    velocity_[node(p)].x = moved / dt;
  }
  keep_list();
  find_forces();
  force -= force_on_right_end();
  work_ += 0.5 * force * moved;
}

void WaveMotion::move_particles() {
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const Force& v = velocity_[node(p)];
    particles_[p].x += time_step_ * v.x;
    particles_[p].y += time_step_ * v.y;
    particles_[p].roll += time_step_ * v.roll;
  }
}

// Contact forces on the right end in x.
double WaveMotion::force_on_right_end() const {
  double sum = 0;
  for (const std::size_t p : right_)
    if (particle_of_[node(p)] == p) sum += forces_[node(p)].x;
  return sum;
}

std::vector<double> WaveMotion::vertical_forces() const {
  std::vector<double> sums(particles_.size(), 0.0);
  for (std::size_t c = 0; c < list_.size(); ++c) {
    sums[static_cast<std::size_t>(list_.i[c])] -= list_.forces[c].y;
    sums[static_cast<std::size_t>(list_.j[c])] += list_.forces[c].y;
  }
  return sums;
}

int WaveMotion::touching() const {
  int count = 0;
  for (std::size_t c = 0; c < list_.size(); ++c) {
    const Force& f = list_.forces[c];
    if (f.x != 0 || f.y != 0) ++count;
  }
  return count;
}

// Stiffness of all listed contacts, touching or not, with their bond or without.
void WaveMotion::find_largest_time_step() {
  const std::size_t n = velocity_.size();
  std::vector<double> translation(n, 0), rotation(n, 0);
  for (std::size_t c = 0; c < list_.size(); ++c) {
    const auto i = static_cast<std::size_t>(list_.i[c]), j = static_cast<std::size_t>(list_.j[c]);
    const double without_bond =
        list_.weight_of(c) * law_.coefficient(specimen_->radius[i], specimen_->radius[j]);
    const double kn = std::max(list_.normal_stiffness[c], without_bond);
    const double kt =
        std::max(list_.tangential_stiffness[c], law_.tangential() ? law_.ratio * without_bond : 0);
    const double kr_without =
        law_.ratio * without_bond * law_.rolling_ratio(specimen_->radius[i], specimen_->radius[j]);
    const double kr =
        list_.bending_stiffness.empty() ? 0 : std::max(list_.bending_stiffness[c], kr_without);
    // A row of |K|: twice the normal and tangential stiffness for a node and its neighbour, kt for
    // both rotations R theta.
    for (const std::int32_t end : {list_.i[c], list_.j[c]}) {
      const auto p = static_cast<std::size_t>(end);
      const double r = specimen_->radius[p];
      translation[node(p)] += 2 * std::max(kn, kt) + 2 * kt;
      rotation[node(p)] += 4 * kt + 2 * kr / (r * r);
    }
  }
  double square = 0;
  for (std::size_t q = 0; q < n; ++q) {
    square = std::max(square, translation[q] * std::max(inverse_mass_[q].x, inverse_mass_[q].y));
    square = std::max(square, rotation[q] * inverse_mass_[q].roll);
  }
  largest_time_step_ = 2 / std::sqrt(square);
}

}  // namespace grainlaw::core
