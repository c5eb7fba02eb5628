#include "contact/disc_sides.hpp"

#include "base/room.hpp"
#include "contact/disc_side_loops.hpp"

#include <algorithm>
#include <numeric>

namespace grainlaw::core {

namespace {

using namespace disc_sides;

GRAINLAW_LOOP(Looked, look_locked_near, look_loop, false, false)
GRAINLAW_LOOP(Looked, look_locked_far, look_loop, false, true)
GRAINLAW_LOOP(Looked, look_near, look_loop, true, false)
GRAINLAW_LOOP(Looked, look_far, look_loop, true, true)
GRAINLAW_LOOP(ContactSides<2>::Measured, step_locked, step_loop, false, false)
GRAINLAW_LOOP(ContactSides<2>::Measured, step_locked_dragged, step_loop, false, true)
GRAINLAW_LOOP(ContactSides<2>::Measured, step_rotating, step_loop, true, false)
GRAINLAW_LOOP(ContactSides<2>::Measured, step_rotating_dragged, step_loop, true, true)

std::size_t at(std::int32_t particle) { return static_cast<std::size_t>(particle); }

}  // namespace

void ContactSides<2>::arrange(const ContactList<2>& list, const Packing& packing,
                              std::span<const LeastMass<2>> least_masses, bool at_rest) {
  const auto& radius = packing.radius;
  particles_ = packing.size();
  const double sum = std::accumulate(radius.begin(), radius.end(), 0.0);
  curvature_ = 0.5 * static_cast<double>(particles_) / sum;
  if (!at_rest) save_velocities();
  slots_.sort(std::span(list.i).first(list.size()), std::span(list.j).first(list.size()),
              particles_, packing.order);
  resize_with_room(nodes_, slots_.groups().size());
  bound_masses(least_masses);
  for (auto* records : {&place_, &moves_, &last_moves_}) {
    resize_with_room(*records, lanes * nodes_.size());
    std::fill(records->begin(), records->end(), ParticleRecord<2>{});
  }
  if (!at_rest) restore_velocities();
  list_sides(list, 2 * *std::max_element(radius.begin(), radius.end()));
}

void ContactSides<2>::save_velocities() {
  resize_with_room(velocity_, particles_);
  for (std::size_t p = 0; p < particles_; ++p) {
    const ParticleRecord<2>& now = moves_[slots_.slot(p)];
    const ParticleRecord<2>& last = last_moves_[slots_.slot(p)];
    velocity_[p] = {now.x - last.x, now.y - last.y, now.roll - last.roll, 0};
  }
}

void ContactSides<2>::restore_velocities() {
  for (std::size_t p = 0; p < particles_; ++p) {
    const ParticleRecord<2>& v = velocity_[p];
    last_moves_[slots_.slot(p)] = {-v.x, -v.y, -v.roll, 0};
  }
}

void ContactSides<2>::bound_masses(std::span<const LeastMass<2>> least_masses) {
  Bounds filling{};
  for (auto* column : {&filling.least, &filling.least_roll}) std::fill_n(*column, lanes, 1.0);
  resize_with_room(bounds_, nodes_.size());
  std::fill(bounds_.begin(), bounds_.end(), filling);
  for (std::size_t p = 0; p < particles_; ++p) {
    const std::size_t slot = slots_.slot(p);
    const std::size_t k = slot % lanes;
    Bounds& bounds = bounds_[slot / lanes];
    bounds.least[k] = least_masses[p].x;
    bounds.least_roll[k] = least_masses[p].roll;
    bounds.inverse_radius[k] = least_masses[p].inverse_radius;
  }
}

void ContactSides<2>::list_sides(const ContactList<2>& list, double longest_reach) {
  // Padding: nodes beside themselves beyond their reach, without stiffness.
  Start nothing{};
  std::fill_n(nothing.offset_x, lanes, 2 * longest_reach);
  std::fill_n(nothing.inverse_reach, lanes, 1 / longest_reach);
  std::fill_n(nothing.x, lanes, 1.0);
  const std::size_t rows = slots_.row_count();
  resize_with_room(starts_, rows);
  std::fill(starts_.begin(), starts_.end(), nothing);
  resize_with_room(sides_, rows);
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
    start.offset_x[k] = sign * list.offset[0][c];
    start.offset_y[k] = sign * list.offset[1][c];
    start.inverse_reach[k] = list.inverse_reach[c];
    start.x[k] = sign * list.start_normal[0][c];
    start.y[k] = sign * list.start_normal[1][c];
    start.roll[k] = list.start_roll[c];
    start.force[k] = list.start_force[0][c];
    Side& side = sides_[row];
    side.other[k] = static_cast<std::int32_t>(slots_.slot(at(other)));
    side.normal_stiffness[k] = list.normal_stiffness[c];
  };
  for (std::size_t c = 0; c < list.size(); ++c) {
    add(c, list.i[c], list.j[c], -1);
    add(c, list.j[c], list.i[c], 1);
  }
}

ContactTotals ContactSides<2>::look(std::span<const ParticleRecord<2>> particles,
                                    const ContactLaw& law, double factor, ContactList<2>& list) {
  for (std::size_t p = 0; p < particles_; ++p) place_[slots_.slot(p)] = particles[p];
  for (std::size_t s = 0; s < moves_.size(); ++s) {
    const ParticleRecord<2>& now = moves_[s];
    ParticleRecord<2>& last = last_moves_[s];
    last = {last.x - now.x, last.y - now.y, last.roll - now.roll, 0};
  }
  std::fill(moves_.begin(), moves_.end(), ParticleRecord<2>{});
  const Loop loop{.groups = slots_.groups(),
                  .nodes = nodes_.data(),
                  .bounds = bounds_.data(),
                  .starts = starts_.data(),
                  .sides = sides_.data(),
                  .records = &place_[0].x,
                  .ratio = law.ratio,
                  .factor = factor};
  Looked seen{};
  if (!list.turns_far) {
    seen = law.rotating() ? look_near(loop) : look_locked_near(loop);
    list.turns_far = seen.beyond > 0;
  }
  if (list.turns_far) seen = law.rotating() ? look_far(loop) : look_locked_far(loop);
  drags_.clear();
  // Half contacts count every contact twice.
  return {0.5 * seen.force, 0.5 * seen.touching, static_cast<int>(0.5 * seen.touching)};
}

void ContactSides<2>::hold(std::span<const ParticleRecord<2>> particles, const NodeDrag<2>& drag,
                           double factor) {
  resize_with_room(drags_, nodes_.size());
  std::fill(drags_.begin(), drags_.end(), Drag{});
  for (std::size_t p = 0; p < particles_; ++p) {
    const std::size_t k = slots_.slot(p) % lanes;
    Drag& of = drags_[slots_.slot(p) / lanes];
    of.stiffness[k] = drag.stiffness[p].x;
    of.stiffness_roll[k] = drag.stiffness[p].roll;
    of.x[k] = drag.expected[p].x - particles[p].x;
    of.y[k] = drag.expected[p].y - particles[p].y;
    of.roll[k] = drag.expected[p].roll - particles[p].roll;
    Nodes& nodes = nodes_[slots_.slot(p) / lanes];
    nodes.mass[k] += factor * of.stiffness[k];
    nodes.gain[k] = 1 / nodes.mass[k];
    nodes.mass_roll[k] += factor * of.stiffness_roll[k];
    nodes.gain_roll[k] = 1 / nodes.mass_roll[k];
  }
}

ContactSides<2>::Measured ContactSides<2>::step(const ContactLaw& law, double keep, double gain) {
  const Loop loop{.groups = slots_.groups(),
                  .nodes = nodes_.data(),
                  .bounds = nullptr,
                  .drags = drags_.data(),
                  .starts = nullptr,
                  .sides = sides_.data(),
                  .records = &moves_[0].x,
                  .last_moves = &last_moves_[0].x,
                  .curvature = curvature_,
                  .friction = law.friction,
                  .ratio = law.ratio,
                  .keep = keep,
                  .gain = gain};
  const auto stepped = [&] {
    if (drags_.empty()) return law.rotating() ? step_rotating(loop) : step_locked(loop);
    return law.rotating() ? step_rotating_dragged(loop) : step_locked_dragged(loop);
  };
  const Measured measured = stepped();
  moves_.swap(last_moves_);
  return measured;
}

void ContactSides<2>::move(std::span<ParticleRecord<2>> particles) const {
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const ParticleRecord<2>& moved = moves_[slots_.slot(p)];
    particles[p].x += moved.x;
    particles[p].y += moved.y;
    particles[p].roll += moved.roll;
  }
}

}  // namespace grainlaw::core
