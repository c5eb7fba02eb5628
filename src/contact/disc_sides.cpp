#include "contact/disc_sides.hpp"

#include "base/room.hpp"
#include "contact/disc_loops.hpp"

#include <algorithm>
#include <numeric>

namespace grainlaw {

namespace {

using namespace simd;
using disc_loops::Columns;
using disc_loops::columns_at;
using disc_loops::GroupSum;
using disc_loops::put_records;
using disc_loops::records_of;
constexpr std::size_t lanes = ContactSides<2>::lanes;
static_assert(lanes == ContactList<2>::group);

struct Loop {
  std::span<const ContactSides<2>::Rows> groups;
  ContactSides<2>::Nodes* nodes;
  const ContactSides<2>::Bounds* bounds;
  const ContactSides<2>::Start* starts;
  ContactSides<2>::Side* sides;
  const double* records;         // of the place, or the moves
  double* last_moves = nullptr;  // in: of the step before; out: of the next
  double curvature = 0, friction = 0, ratio = 0, factor = 0, keep = 0, gain = 0;
};

struct Looked {
  double beyond;  // > 0: a touching branch turned beyond the short series
  double force, touching;
};

template <std::size_t width, bool rotating, bool far>
GRAINLAW_INLINE Looked look_loop(const Loop& loop) {
  using V = Lanes<width>;
  const V zero{};
  const V one = zero + 1.0;
  const double ratio = loop.ratio;
  V beyond{};
  GroupSum<width> force, touching;
  const double* own_records = loop.records;
  for (std::size_t g = 0; g < loop.groups.size(); ++g) {
    const ContactSides<2>::Rows rows = loop.groups[g];
    ContactSides<2>::Nodes& nodes = loop.nodes[g];
    const ContactSides<2>::Bounds& bounds = loop.bounds[g];
    for (std::size_t k = 0; k < lanes; k += width, own_records += 4 * width) {
      const Columns<width> own = columns_at<width>(own_records);
      V stiffness{}, stiffness_roll{};
      for (std::size_t row = rows.first; row < rows.first + rows.count; ++row) {
        const ContactSides<2>::Start& start = loop.starts[row];
        ContactSides<2>::Side& side = loop.sides[row];
        const Columns<width> other = records_of<width>(loop.records, side.other + k);
        const V x = own.x - other.x + load<width>(start.offset_x + k);
        const V y = own.y - other.y + load<width>(start.offset_y + k);
        const V distance = square_root(x * x + y * y + disc_loops::tiny);
        const V inverse = 1 / distance;
        const V overlap = own.last + other.last - distance;
        const auto here = overlap > zero;
        const V kn = load<width>(side.normal_stiffness + k);
        const V fn = kn * overlap;
        store(side.normal_x + k, x * inverse);
        store(side.normal_y + k, y * inverse);
        store(side.normal_force + k, fn);
        const V start_x = load<width>(start.x + k);
        const V start_y = load<width>(start.y + k);
        const V dot = start_x * x + start_y * y;
        const V cross = start_x * y - start_y * x;
        const V sine = cross * inverse;
        const V excess = dot > zero ? magnitude(sine) - short_series : one;
        beyond = largest(beyond, here ? excess : zero);
        V slip = distance;
        if constexpr (far) {
          slip *= far_turn(distance, dot, cross);
        } else {
          slip *= arc_sine(sine);
        }
        const V kt = ratio * kn;
        if constexpr (rotating) {
          const V stretch = distance * load<width>(start.inverse_reach + k);
          slip += stretch * (load<width>(start.roll + k) - (own.roll + other.roll));
          store(side.stretch + k, stretch);
          stiffness_roll += here ? kt * distance * stretch : zero;
        }
        store(side.trial + k, load<width>(start.force + k) - kt * slip);
        stiffness += here ? kn : zero;
        force.add(k, here ? fn : zero);
        touching.add(k, here ? one : zero);
      }
      const auto put_mass = [&](const V& sum, const double* least, double* mass, double* gain) {
        const V value = loop.factor * largest(sum, load<width>(least + k));
        store(mass + k, value);
        store(gain + k, 1 / value);
      };
      put_mass(stiffness, bounds.least, nodes.mass, nodes.gain);
      if constexpr (rotating) {
        put_mass(stiffness_roll * load<width>(bounds.inverse_radius + k), bounds.least_roll,
                 nodes.mass_roll, nodes.gain_roll);
      }
    }
  }
  return {most(beyond), force.total(), touching.total()};
}

template <std::size_t width, bool rotating>
GRAINLAW_INLINE ContactSides<2>::Measured step_loop(const Loop& loop) {
  using V = Lanes<width>;
  const V zero{};
  const double friction = loop.friction;
  const double ratio = loop.ratio;
  const double curvature = loop.curvature;
  V largest_force{};
  GroupSum<width> power, next_power, inertia;
  double* last_moves = loop.last_moves;
  const double* own_records = loop.records;
  for (std::size_t g = 0; g < loop.groups.size(); ++g) {
    const ContactSides<2>::Rows rows = loop.groups[g];
    const ContactSides<2>::Nodes& nodes = loop.nodes[g];
    for (std::size_t k = 0; k < lanes;
         k += width, last_moves += 4 * width, own_records += 4 * width) {
      Columns<width> own = columns_at<width>(own_records);
      V x{}, y{}, roll{};
      const ContactSides<2>::Side* side = loop.sides + rows.first;
      for (const auto* const end = side + rows.count; side != end; ++side) {
        const Columns<width> other = records_of<width>(loop.records, side->other + k);
        const V ux = own.x - other.x;
        const V uy = own.y - other.y;
        const V nx = load<width>(side->normal_x + k);
        const V ny = load<width>(side->normal_y + k);
        const V kn = load<width>(side->normal_stiffness + k);
        const V fn = largest(load<width>(side->normal_force + k) - kn * (nx * ux + ny * uy), zero);
        const V across = nx * uy - ny * ux;
        const V turn = curvature * across;
        const V ax = nx - turn * ny;
        const V ay = ny + turn * nx;
        V slip = across;
        V stretch{};
        if constexpr (rotating) {
          stretch = load<width>(side->stretch + k);
          slip -= stretch * (own.roll + other.roll);
        }
        const V trial = load<width>(side->trial + k) - ratio * kn * slip;
        const V bound = friction * fn;
        const V ft = smallest(largest(trial, -bound), bound);
        x += fn * ax - ft * ay;
        y += fn * ay + ft * ax;
        if constexpr (rotating) roll -= stretch * ft;
      }
      V work{}, next_work{}, twice_energy{};
      const Columns<width> last = columns_at<width>(last_moves);
      const auto go_on = [&](const V& force, const double* mass, const double* gain,
                             const V& before, V& moved) {
        const V v = moved - before;
        largest_force = largest(largest_force, magnitude(force));
        work += v * force;
        twice_energy += v * load<width>(mass + k) * v;
        const V next = loop.keep * v + loop.gain * force * load<width>(gain + k);
        next_work += next * force;
        moved += next;
      };
      go_on(x, nodes.mass, nodes.gain, last.x, own.x);
      go_on(y, nodes.mass, nodes.gain, last.y, own.y);
      if constexpr (rotating) go_on(roll, nodes.mass_roll, nodes.gain_roll, last.roll, own.roll);
      power.add(k, work);
      next_power.add(k, next_work);
      inertia.add(k, twice_energy);
      put_records<width>(own, last_moves);
    }
  }
  return {most(largest_force), power.total(), next_power.total(), inertia.total()};
}

GRAINLAW_LOOP(Looked, look_locked_near, look_loop, false, false)
GRAINLAW_LOOP(Looked, look_locked_far, look_loop, false, true)
GRAINLAW_LOOP(Looked, look_near, look_loop, true, false)
GRAINLAW_LOOP(Looked, look_far, look_loop, true, true)
GRAINLAW_LOOP(ContactSides<2>::Measured, step_locked, step_loop, false)
GRAINLAW_LOOP(ContactSides<2>::Measured, step_rotating, step_loop, true)

std::size_t at(std::int32_t particle) { return static_cast<std::size_t>(particle); }

}  // namespace

void ContactSides<2>::arrange(const ContactList<2>& list, const Packing& packing,
                              std::span<const LeastMass<2>> least_masses, bool at_rest) {
  const auto& radius = packing.radius;
  particles_ = packing.size();
  const double sum = std::accumulate(radius.begin(), radius.end(), 0.0);
  curvature_ = 0.5 * static_cast<double>(particles_) / sum;
  if (!at_rest) save_velocities();
  sort_nodes(list, packing.order, least_masses);
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
    const ParticleRecord<2>& now = moves_[slot_[p]];
    const ParticleRecord<2>& last = last_moves_[slot_[p]];
    velocity_[p] = {now.x - last.x, now.y - last.y, now.roll - last.roll, 0};
  }
}

void ContactSides<2>::restore_velocities() {
  for (std::size_t p = 0; p < particles_; ++p) {
    const ParticleRecord<2>& v = velocity_[p];
    last_moves_[slot_[p]] = {-v.x, -v.y, -v.roll, 0};
  }
}

// By the number of their sides, so that the rows of a group are full; by counting.
void ContactSides<2>::sort_nodes(const ContactList<2>& list, std::span<const std::int32_t> order,
                                 std::span<const LeastMass<2>> least_masses) {
  resize_with_room(count_, particles_);
  std::fill(count_.begin(), count_.end(), 0U);
  std::uint32_t most = 15;  // nearly always enough, so that the counts keep their size
  for (std::size_t c = 0; c < list.size(); ++c) {
    most = std::max(most, ++count_[at(list.i[c])]);
    most = std::max(most, ++count_[at(list.j[c])]);
  }
  resize_with_room(first_slot_, most + 2);
  std::fill(first_slot_.begin(), first_slot_.end(), 0U);
  for (const std::uint32_t count : count_) ++first_slot_[count + 1];
  std::partial_sum(first_slot_.begin(), first_slot_.end(), first_slot_.begin());

  Bounds filling{};
  for (auto* column : {&filling.least, &filling.least_roll}) std::fill_n(*column, lanes, 1.0);
  const std::size_t groups = (particles_ + lanes - 1) / lanes;
  resize_with_room(nodes_, groups);
  resize_with_room(bounds_, groups);
  std::fill(bounds_.begin(), bounds_.end(), filling);
  resize_with_room(rows_, groups);
  std::fill(rows_.begin(), rows_.end(), Rows{});
  resize_with_room(slot_, particles_);
  for (std::size_t q = 0; q < particles_; ++q) {
    const std::size_t p = order.empty() ? q : at(order[q]);
    slot_[p] = first_slot_[count_[p]]++;
    Bounds& bounds = bounds_[slot_[p] / lanes];
    const std::size_t k = slot_[p] % lanes;
    bounds.least[k] = least_masses[p].x;
    bounds.least_roll[k] = least_masses[p].roll;
    bounds.inverse_radius[k] = least_masses[p].inverse_radius;
    Rows& rows = rows_[slot_[p] / lanes];
    rows.count = std::max(rows.count, count_[p]);
  }
  std::uint32_t first = 0;
  for (Rows& rows : rows_) {
    rows.first = first;
    first += rows.count;
  }
}

void ContactSides<2>::list_sides(const ContactList<2>& list, double longest_reach) {
  // Filled up with nodes beside themselves, further than they reach, without stiffness.
  Start nothing{};
  std::fill_n(nothing.offset_x, lanes, 2 * longest_reach);
  std::fill_n(nothing.inverse_reach, lanes, 1 / longest_reach);
  std::fill_n(nothing.x, lanes, 1.0);
  const std::size_t rows = rows_.back().first + rows_.back().count;
  resize_with_room(starts_, rows);
  std::fill(starts_.begin(), starts_.end(), nothing);
  resize_with_room(sides_, rows);
  std::fill(sides_.begin(), sides_.end(), Side{});
  std::int32_t first = 0;
  for (const Rows& group : rows_) {
    for (std::size_t row = group.first; row < group.first + group.count; ++row) {
      std::iota(sides_[row].other, sides_[row].other + lanes, first);
    }
    first += lanes;
  }
  std::fill(count_.begin(), count_.end(), 0U);
  const auto add = [&](std::size_t c, std::int32_t node, std::int32_t other, double sign) {
    const std::size_t slot = slot_[at(node)];
    const std::size_t row = rows_[slot / lanes].first + count_[at(node)]++;
    const std::size_t k = slot % lanes;
    Start& start = starts_[row];
    start.offset_x[k] = sign * list.offset[0][c];
    start.offset_y[k] = sign * list.offset[1][c];
    start.inverse_reach[k] = list.inverse_reach[c];
    start.x[k] = sign * list.start_normal[0][c];
    start.y[k] = sign * list.start_normal[1][c];
    start.roll[k] = list.start_roll[c];
    start.force[k] = list.start_force[0][c];
    Side& side = sides_[row];
    side.other[k] = static_cast<std::int32_t>(slot_[at(other)]);
    side.normal_stiffness[k] = list.normal_stiffness[c];
  };
  for (std::size_t c = 0; c < list.size(); ++c) {
    add(c, list.i[c], list.j[c], -1);
    add(c, list.j[c], list.i[c], 1);
  }
}

ContactTotals ContactSides<2>::look(std::span<const ParticleRecord<2>> particles,
                                    const ContactLaw& law, double factor, ContactList<2>& list) {
  for (std::size_t p = 0; p < particles_; ++p) place_[slot_[p]] = particles[p];
  for (std::size_t s = 0; s < moves_.size(); ++s) {
    const ParticleRecord<2>& now = moves_[s];
    ParticleRecord<2>& last = last_moves_[s];
    last = {last.x - now.x, last.y - now.y, last.roll - now.roll, 0};
  }
  std::fill(moves_.begin(), moves_.end(), ParticleRecord<2>{});
  const Loop loop{.groups = rows_,
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
  // Every contact was seen twice.
  return {0.5 * seen.force, 0.5 * seen.touching, static_cast<int>(0.5 * seen.touching)};
}

ContactSides<2>::Measured ContactSides<2>::step(const ContactLaw& law, double keep, double gain) {
  const Loop loop{.groups = rows_,
                  .nodes = nodes_.data(),
                  .bounds = nullptr,
                  .starts = nullptr,
                  .sides = sides_.data(),
                  .records = &moves_[0].x,
                  .last_moves = &last_moves_[0].x,
                  .curvature = curvature_,
                  .friction = law.friction,
                  .ratio = law.ratio,
                  .keep = keep,
                  .gain = gain};
  const Measured measured = law.rotating() ? step_rotating(loop) : step_locked(loop);
  moves_.swap(last_moves_);
  return measured;
}

void ContactSides<2>::move(std::span<ParticleRecord<2>> particles) const {
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const ParticleRecord<2>& moved = moves_[slot_[p]];
    particles[p].x += moved.x;
    particles[p].y += moved.y;
    particles[p].roll += moved.roll;
  }
}

}  // namespace grainlaw
