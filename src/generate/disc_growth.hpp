// Hard discs that fly, collide and grow in a periodic box, event by event.
#pragma once

#include "generate/generator.hpp"
#include "packing/packing.hpp"

#include <array>
#include <functional>
#include <limits>
#include <queue>
#include <random>
#include <utility>
#include <vector>

namespace grainlaw::core {

struct Disc {
  double x, y;    // at `time`, not wrapped
  double u, v;    // velocity
  double radius;  // at scale 1
  double time;
  std::array<long, 2> cell;  // of the grid that repeats, not wrapped
  unsigned long turns = 0;   // collisions so far: older predictions are void
};

// The box has side 1; radii at time t are radius x (scale + rate t).
class DiscGrowth {
 public:
  // Small enough that places are found at once; far below the density where growth is slow.
  static constexpr double start_fraction = 0.3;

  DiscGrowth(const GeneratorOptions& options, const std::vector<double>& radii);

  // Takes over places in the unit box and draws velocities.
  void place(const Packing& start, std::mt19937_64& engine);

  // Whether the discs jammed, rather than reaching the end of growth.
  bool run();

  [[nodiscard]] const std::vector<Disc>& discs() const { return discs_; }

  // A scale just below the largest at which no two discs overlap.
  [[nodiscard]] double free_scale() const;

 private:
  // What a disc does next: meet disc `partner` (shifted by `shift` boxes), or leave its grid cell.
  struct Event {
    double time = std::numeric_limits<double>::infinity();
    int disc = 0;
    int partner = -1;
    std::array<long, 2> shift{};
    unsigned long turns = 0;
    unsigned long partner_turns = 0;

    bool operator>(const Event& other) const {
      return std::pair(time, disc) > std::pair(other.time, other.disc);
    }
  };

  [[nodiscard]] std::size_t bucket(long a, long b) const;

  // Discs in the 3 x 3 cells around, with the boxes by which they are shifted to lie there.
  template <class Visit>
  void for_neighbours(const Disc& disc, const Visit& visit) const;

  // Time until the gap closes, from now on.
  [[nodiscard]] double meeting(const Disc& a, const Disc& b,
                               const std::array<long, 2>& shift) const;

  void predict(std::size_t i);  // the disc must be up to date
  void bring_up(Disc& disc) const;
  void collide(Disc& a, Disc& b, const std::array<long, 2>& shift);
  void enter_next_cell(std::size_t i);

  // So many collisions, or to the end of growth, which is told.
  bool run_block(long collisions);

  // p V / (N k T) over the time since the last scaling; 2 dimensions, masses 1.
  [[nodiscard]] double reduced_pressure() const;

  // Mean squared velocity 1 and no drift, clock and growth restarted here, all events anew.
  void rescale();

  std::vector<Disc> discs_;
  std::vector<std::vector<int>> members_;  // of each grid cell
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  long cells_ = 1;    // along a side; each at least as wide as the largest diameter
  double rate_ = 0;   // of the scale
  double scale_ = 1;  // when the clock was last set to 0
  double end_scale_ = 1;
  double now_ = 0;
  double virial_ = 0;  // sum of kick x distance since then
};

}  // namespace grainlaw::core
