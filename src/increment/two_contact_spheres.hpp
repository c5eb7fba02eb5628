// Two-contact spheres: equilibrium leaves their rotation about the chord between both contacts
// open.
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
class ForceBalance;

// Rule for two-contact spheres. Such a sphere may roll along a path around the chord, on which all
// positions are in equilibrium but P differs. @formula free-spin The rule: since the start of the
// history the sphere has not moved along the path, relative to its neighbours' affine motion. A
// third sphere in the way stops it. A spring about the chord enforces the rule; its moment vanishes
// at the solution.
class TwoContactSpheres {
 public:
  // Two-contact sphere with its excess over the rule, chord . rotation + way . departure [rad], or
  // over its stop at a third sphere.
  struct TwoContactSphere {
    std::size_t node;
    std::array<std::size_t, 2> contact;  // indices in the increment's list
    std::array<std::size_t, 2> neighbour;
    std::array<double, 2> side;  // 1 if the node is the contact's first, else -1
    Vec<3> chord;                // at the start of the history, over the radius [-]
    double way_scale;            // [1/m]
    Vec<3> way;        // way_scale x chord x (first contact point over radius), at the start [1/m]
    Vec<3> departure;  // of the neighbours' mean from affine motion, relative to the sphere [m]
    Vec<3> by_spin;    // derivative of the excess by spin [-]
    double excess;     // [rad]
    double stiffness;  // [N m]
    std::size_t third = none;  // index of its contact
    std::size_t third_neighbour;
    double third_side;
    Vec<3> by_third;  // derivative of the excess by the third branch, outwards [1/m]

    [[nodiscard]] bool stopped() const { return third != none; }
    // Moment of the spring over the radius [N].
    [[nodiscard]] double force(double radius) const {
      return stiffness * std::abs(excess) * length<3>(chord) / radius;
    }
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  // True if neither the law nor drag resists rotation about the chord.
  static bool possible(const ForceBalance<3>& balance);
  void forget() {
    spheres_.clear();
    arbitrary_ = false;
  }
  // Finds the two-contact spheres at the present coordinates, with the present masses.
  void find(const ForceBalance<3>& balance);
  // Adds the moments of the springs to the residual [N m].
  void add_to(std::size_t nodes, std::span<double> residual) const;

  [[nodiscard]] std::span<const TwoContactSphere> spheres() const { return spheres_; }
  // True if some stop at an unsupported sphere, or two at each other: where they are depends on the
  // relaxation.
  [[nodiscard]] bool arbitrary() const { return arbitrary_; }

 private:
  // Limit of the excess at a third sphere, in one direction of rolling.
  struct Limit {
    double room;  // [rad]
    std::size_t contact;
    Vec<3> by_branch;
  };
  [[nodiscard]] TwoContactSphere sphere_at(const ForceBalance<3>& balance, std::size_t node) const;
  void find_limits(const ForceBalance<3>& balance);
  void limit_by_third(const ForceBalance<3>& balance, std::size_t contact, std::size_t node,
                      double side);
  void stop(const ForceBalance<3>& balance);
  [[nodiscard]] bool stops_itself(const TwoContactSphere& sphere) const;

  std::vector<TwoContactSphere> spheres_;
  std::vector<unsigned char> count_;  // contacts of a node, at most three
  std::vector<std::array<std::size_t, 2>> contact_;
  std::vector<std::size_t> index_;  // index of a node in spheres_
  std::vector<std::array<Limit, 2>> limits_;
  bool arbitrary_ = false;
};

}  // namespace grainlaw::core
