// Spheres with two contacts, which nothing holds against a spin about the chord between these.
#pragma once

#include "math/dimension.hpp"
#include "math/tensor.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

template <int D>
class Increment;

// The sphere may roll around the chord on both, and the contacts' forces have no moment about that: what
// balances them is a whole line of places, on which P is not the same. The rule that picks one: since the
// history started the sphere has not gone that way from where F carries it between its neighbours; where a
// third sphere is in the way, it is where it meets that. A spring about the chord, without moment where the
// rule is kept, holds to it.
class FreeSpins {
 public:
  // The excess over the rule, chord . rotation + way . departure [rad], or what is left to the third sphere
  // before that.
  struct Held {
    std::size_t node;
    std::array<std::size_t, 2> contact;  // in the increment's list
    std::array<std::size_t, 2> neighbour;
    std::array<double, 2> side;  // 1 where the node is the first of the contact, else -1
    Vec<3> chord;                // where the history started, over the radius [-]
    double way_scale;            // [1/m]
    Vec<3> way;        // way_scale x chord x first point of contact over the radius, there [1/m]
    Vec<3> departure;  // of the neighbours' mean from where F carries it, seen from the sphere [m]
    Vec<3> by_spin;    // of the excess [-]
    double excess;     // [rad]
    double stiffness;  // [N m]
    std::size_t third = none;  // contact
    std::size_t third_neighbour;
    double third_side;
    Vec<3> by_third;  // of the excess by the third branch, outwards [1/m]

    [[nodiscard]] bool stopped() const { return third != none; }
    // On the surface [N].
    [[nodiscard]] double force(double radius) const {
      return stiffness * std::abs(excess) * length<3>(chord) / radius;
    }
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  // Whether contacts leave spins free at all.
  static bool possible(const Increment<3>& increment);
  void forget() {
    held_.clear();
    by_chance_ = false;
  }
  // At the present coordinates, with the present masses.
  void find(const Increment<3>& increment);
  // What the springs do to the residual.
  void add_to(std::size_t nodes, std::span<double> residual) const;

  [[nodiscard]] std::span<const Held> held() const { return held_; }
  // Whether some are stopped by spheres that nothing holds, which are where a relaxation left them.
  [[nodiscard]] bool by_chance() const { return by_chance_; }

 private:
  // Where a third sphere leaves so much of the excess on the one way and on the other.
  struct Limit {
    double room;  // [rad]
    std::size_t contact;
    Vec<3> by_branch;
  };
  [[nodiscard]] Held held_at(const Increment<3>& increment, std::size_t node) const;
  void find_limits(const Increment<3>& increment);
  void see_third(const Increment<3>& increment, std::size_t contact, std::size_t node, double side);
  void stop(const Increment<3>& increment);

  std::vector<Held> held_;
  std::vector<unsigned char> count_;  // contacts of a node, up to three
  std::vector<std::array<std::size_t, 2>> contact_;
  std::vector<std::size_t> place_;  // of a node in held_
  std::vector<std::array<Limit, 2>> limits_;
  bool by_chance_ = false;
};

}  // namespace grainlaw::core
