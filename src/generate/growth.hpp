// Hard discs or spheres that fly, collide and grow in a periodic box, event by event.
#pragma once

#include "generate/generator.hpp"
#include "math/tensor.hpp"
#include "packing/neighbour_keys.hpp"
#include "packing/packing.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <random>
#include <utility>
#include <vector>

namespace grainlaw::core {

// Event-driven dynamics in a box of side 1; radii at time t are radius x (scale + rate t).
template <int D>
class Growth {
 public:
  // Volume fraction of the start: random positions are found quickly, and growth is still fast.
  static constexpr double start_fraction = D == 2 ? 0.3 : 0.2;

  using Cells = std::array<std::int32_t, static_cast<std::size_t>(D)>;
  struct Particle {
    Vec<D> position;  // at `time`, not wrapped
    Vec<D> velocity;
    double radius;  // radius at scale 1
    double time;
    Cells cell;                    // of the periodic grid, not wrapped
    unsigned long collisions = 0;  // collisions so far; predictions with fewer are void
  };

  Growth(const GeneratorOptions& options, const std::vector<double>& radii);

  // Takes positions in the unit box and draws velocities.
  void begin(const Packing& start, std::mt19937_64& engine);

  // Runs to jamming or to the end of growth; returns whether the particles jammed.
  bool run();

  [[nodiscard]] const std::vector<Particle>& particles() const { return particles_; }

  // A scale just below the largest at which no two particles overlap.
  [[nodiscard]] double free_scale() const;

 private:
  static constexpr std::size_t dim = D;

  // Next event of a particle: a collision with `partner` (shifted by `shift` boxes), or leaving its
  // grid cell.
  struct Event {
    double time = std::numeric_limits<double>::infinity();
    int particle = 0;
    int partner = -1;
    Cells shift{};
    unsigned long collisions = 0;
    unsigned long partner_collisions = 0;

    bool operator>(const Event& other) const {
      return std::pair(time, particle) > std::pair(other.time, other.particle);
    }
  };

  [[nodiscard]] std::size_t bucket(const Cells& cell) const;

  // Calls visit for particles in the adjacent cells, with their shifts in boxes.
  template <class Visit>
  void for_neighbours(const Particle& particle, const Visit& visit) const;

  // Time from now until the gap closes.
  [[nodiscard]] double meeting(const Particle& a, const Particle& b, const Cells& shift) const;

  void predict(std::size_t i);  // the particle must be up to date
  void bring_up(Particle& particle) const;
  void collide(Particle& a, Particle& b, const Cells& shift);
  void enter_next_cell(std::size_t i);

  // Runs so many collisions or to the end of growth; returns whether growth ended.
  bool run_block(long collisions);

  // p V / (N k T) over the time since the last scaling; masses 1.
  [[nodiscard]] double reduced_pressure() const;

  // Rescales velocities to a mean square of 1 without drift, restarts clock and growth, and
  // predicts all events anew.
  void rescale();

  std::vector<Particle> particles_;
  std::vector<std::vector<int>> members_;  // particles per grid cell
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  std::int32_t cells_ = 1;  // per side; each at least one largest diameter wide
  double rate_ = 0;         // growth rate of the scale
  double scale_ = 1;        // scale when the clock was last 0
  double end_scale_ = 1;
  double now_ = 0;
  double virial_ = 0;  // sum of impulse x distance since then
};

// Branch from a to b, which is shifted by so many boxes.
template <class Particle, class Cells>
auto branch_of(const Particle& a, const Particle& b, const Cells& shift) {
  auto branch = b.position;
  for (std::size_t k = 0; k < shift.size(); ++k) {
    branch[k] = branch[k] + static_cast<double>(shift[k]) - a.position[k];
  }
  return branch;
}

template <int D>
template <class Visit>
void Growth<D>::for_neighbours(const Particle& particle, const Visit& visit) const {
  Cells first = particle.cell;
  Cells last = particle.cell;
  for (std::size_t k = 0; k < dim; ++k) {
    --first[k];
    ++last[k];
  }
  neighbour::for_box(first, last, [&](const Cells& at) {
    for (const int j : members_[bucket(at)]) {
      const Particle& other = particles_[static_cast<std::size_t>(j)];
      Cells shift;
      for (std::size_t k = 0; k < dim; ++k) shift[k] = (at[k] - other.cell[k]) / cells_;
      visit(static_cast<std::size_t>(j), shift);
    }
  });
}

}  // namespace grainlaw::core
