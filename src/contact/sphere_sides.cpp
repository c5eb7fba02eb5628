#include "contact/sphere_sides.hpp"

#include "base/room.hpp"
#include "contact/sphere_side_loops.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace grainlaw::core {

namespace {

using namespace sphere_sides;

#define GRAINLAW_SIDES_LOOP(Result, name, loop_of, ...) \
  GRAINLAW_BY_LANES(Result, name, loop_of, (const SideLoop& loop), (loop), __VA_ARGS__)
GRAINLAW_SIDES_LOOP(Looked, look_locked, look_loop, false)
GRAINLAW_SIDES_LOOP(Looked, look_rotating, look_loop, true)
GRAINLAW_SIDES_LOOP(Sides::Measured, step_locked, step_loop, false, false)
GRAINLAW_SIDES_LOOP(Sides::Measured, step_locked_dragged, step_loop, false, true)
GRAINLAW_SIDES_LOOP(Sides::Measured, step_rotating, step_loop, true, false)
GRAINLAW_SIDES_LOOP(Sides::Measured, step_rotating_dragged, step_loop, true, true)

std::size_t at(std::int32_t particle) { return static_cast<std::size_t>(particle); }

}  // namespace

void ContactSides<3>::arrange(const ContactList<3>& list, const Packing& packing,
                              std::span<const LeastMass<3>> least_masses, bool at_rest) {
  particles_ = packing.size();
  if (!at_rest) {
    resize_with_room(velocity_, particles_);
    for (std::size_t p = 0; p < particles_; ++p) {
      const std::size_t slot = slots_.slot(p);
      const Nodes& nodes = nodes_[slot / lanes];
      for (std::size_t c = 0; c < size; ++c) velocity_[p][c] = nodes.velocity[c][slot % lanes];
    }
  }
  slots_.sort(std::span(list.i).first(list.size()), std::span(list.j).first(list.size()),
              particles_, packing.order);
  const std::size_t groups = slots_.groups().size();
  resize_with_room(nodes_, groups);
  std::fill(nodes_.begin(), nodes_.end(), Nodes{});
  Bounds filling{};
  for (auto* column : {&filling.least, &filling.least_spin}) std::fill_n(*column, lanes, 1.0);
  resize_with_room(bounds_, groups);
  std::fill(bounds_.begin(), bounds_.end(), filling);
  for (std::size_t p = 0; p < particles_; ++p) {
    const std::size_t slot = slots_.slot(p);
    const std::size_t k = slot % lanes;
    Bounds& bounds = bounds_[slot / lanes];
    bounds.least[k] = least_masses[p].x;
    bounds.least_spin[k] = least_masses[p].spin;
    bounds.inverse_radius[k] = least_masses[p].inverse_radius;
    if (at_rest) continue;
    Nodes& nodes = nodes_[slot / lanes];
    for (std::size_t c = 0; c < size; ++c) nodes.velocity[c][k] = velocity_[p][c];
  }
  for (auto* records : {&place_, &moves_, &next_moves_}) {
    resize_with_room(*records, lanes * groups);
    std::fill(records->begin(), records->end(), ParticleRecord<3>{});
  }
  const double largest = *std::max_element(packing.radius.begin(), packing.radius.end());
  for (ParticleRecord<3>& record : place_) record.radius = largest;
  list_sides(list, 2 * largest);
}

void ContactSides<3>::list_sides(const ContactList<3>& list, double longest_reach) {
  // Padding: nodes beside themselves beyond their reach, without stiffness.
  Start nothing{};
  std::fill_n(nothing.offset[0], lanes, 2 * longest_reach);
  std::fill_n(nothing.inverse_reach, lanes, 1 / longest_reach);
  std::fill_n(nothing.normal[0], lanes, 1.0);
  resize_with_room(starts_, slots_.row_count());
  std::fill(starts_.begin(), starts_.end(), nothing);
  resize_with_room(sides_, slots_.row_count());
  std::fill(sides_.begin(), sides_.end(), Side{});
  std::int32_t first = 0;
  for (const auto& group : slots_.groups()) {
    for (std::size_t row = group.first; row < group.first + group.count; ++row) {
      std::iota(sides_[row].other, sides_[row].other + lanes, first);
    }
    first += lanes;
  }
  const auto add = [&](std::size_t c, std::int32_t node, std::int32_t other, double sign) {
    const std::size_t row = slots_.next_row(at(node));
    const std::size_t k = slots_.slot(at(node)) % lanes;
    Start& start = starts_[row];
    start.inverse_reach[k] = list.inverse_reach[c];
    for (std::size_t m = 0; m < 3; ++m) {
      start.offset[m][k] = sign * list.offset[m][c];
      start.normal[m][k] = sign * list.start_normal[m][c];
      start.force[m][k] = sign * list.start_force[m][c];
    }
    Side& side = sides_[row];
    side.other[k] = static_cast<std::int32_t>(slots_.slot(at(other)));
    side.normal_stiffness[k] = list.normal_stiffness[c];
  };
  for (std::size_t c = 0; c < list.size(); ++c) {
    add(c, list.i[c], list.j[c], -1);
    add(c, list.j[c], list.i[c], 1);
  }
}

ContactTotals ContactSides<3>::look(std::span<const ParticleRecord<3>> particles,
                                    const ContactLaw& law, double factor,
                                    ContactList<3>& /*list*/) {
  for (std::size_t p = 0; p < particles_; ++p) place_[slots_.slot(p)] = particles[p];
  for (Nodes& nodes : nodes_) std::fill_n(nodes.moved[0], size * lanes, 0.0);
  std::fill(moves_.begin(), moves_.end(), ParticleRecord<3>{});
  const SideLoop loop{.groups = slots_.groups(),
                      .nodes = nodes_.data(),
                      .bounds = bounds_.data(),
                      .starts = starts_.data(),
                      .sides = sides_.data(),
                      .records = &place_[0].x,
                      .ratio = law.ratio,
                      .factor = factor};
  const Looked seen = law.rotating() ? look_rotating(loop) : look_locked(loop);
  drags_.clear();
  // Half contacts count every contact twice.
  return {0.5 * seen.force, 0.5 * seen.touching, static_cast<int>(0.5 * seen.touching)};
}

void ContactSides<3>::hold(std::span<const ParticleRecord<3>> particles, const NodeDrag<3>& drag,
                           double factor) {
  resize_with_room(drags_, nodes_.size());
  std::fill(drags_.begin(), drags_.end(), Drag{});
  for (std::size_t p = 0; p < particles_; ++p) {
    const std::size_t slot = slots_.slot(p);
    const std::size_t k = slot % lanes;
    Drag& of = drags_[slot / lanes];
    of.stiffness[k] = drag.stiffness[p].x;
    of.stiffness_spin[k] = drag.stiffness[p].spin_x;
    for (std::size_t c = 0; c < size; ++c) {
      of.distance[c][k] = component(drag.expected[p], c) - component(particles[p], c);
    }
    Nodes& nodes = nodes_[slot / lanes];
    nodes.mass[k] += factor * of.stiffness[k];
    nodes.gain[k] = 1 / nodes.mass[k];
    nodes.mass_spin[k] += factor * of.stiffness_spin[k];
    nodes.gain_spin[k] = 1 / nodes.mass_spin[k];
  }
}

Sides::Measured ContactSides<3>::step(const ContactLaw& law, double keep, double gain) {
  const SideLoop loop{.groups = slots_.groups(),
                      .nodes = nodes_.data(),
                      .bounds = nullptr,
                      .drags = drags_.data(),
                      .starts = nullptr,
                      .sides = sides_.data(),
                      .records = &moves_[0].x,
                      .next_moves = &next_moves_[0].x,
                      .friction = law.friction,
                      .ratio = law.ratio,
                      .keep = keep,
                      .gain = gain};
  const auto stepped = [&] {
    if (drags_.empty()) return law.rotating() ? step_rotating(loop) : step_locked(loop);
    return law.rotating() ? step_rotating_dragged(loop) : step_locked_dragged(loop);
  };
  const Measured measured = stepped();
  moves_.swap(next_moves_);
  return measured;
}

void ContactSides<3>::move(std::span<ParticleRecord<3>> particles) const {
  for (std::size_t p = 0; p < particles.size(); ++p) {
    ParticleRecord<3>& particle = particles[p];
    const ParticleRecord<3>& moved = moves_[slots_.slot(p)];
    double eta_square = 0;
    for (std::size_t c = 0; c < size; ++c) {
      double& value = component(particle, c);
      value += component(moved, c);
      if (c >= 3) eta_square += value * value;
    }
    particle.half = 0.5 / std::sqrt(1 + 0.25 * eta_square / (particle.radius * particle.radius));
  }
}

}  // namespace grainlaw::core
