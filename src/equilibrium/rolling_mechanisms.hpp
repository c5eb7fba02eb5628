// Rolling mechanisms: discs that roll on each other like gears, with no stiffness and no friction
// against it.
#pragma once

#include "increment/increment.hpp"
#include "tangent/stiffness.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// A cluster of discs that stick to each other, without odd cycles, and slide on all others can
// rotate at constant forces, without stiffness. Most clusters are in balance at any rotation. In
// others the moment makes Newton steps diverge and relaxations slow, until a contact sticks again.
template <int D>
class RollingMechanisms;

template <>
class RollingMechanisms<2> {
 public:
  // True for discs that are their own nodes and whose contacts transmit no moments.
  static bool possible(const Problem<2>& problem);

  // Finds the clusters of the contacts that touch at the present coordinates.
  void find(const Increment<2>& increment, std::span<const TouchingContact<2>> touching);
  // Adds stiffness against rotation to one disc of every cluster.
  void regularise(const Increment<2>& increment, Stiffness<2>& stiffness) const;
  // Records the clusters whose regularisation took more than `least` [N] on the surface in a step.
  // No other motion balances that. The record lasts until they rotate or until the next step.
  void see(const Increment<2>& increment, std::span<const double> step, double least);
  void forget(const Increment<2>& increment);
  // Rotates the recorded clusters with a moment above `least` [N] to where it vanishes, in the
  // motion's coordinates. Returns whether one rotated; then find() is due.
  bool rotate(Increment<2>& increment, double least);

 private:
  struct Sliding {
    double trial, bound, stiffness;  // trial force and friction limit [N]; kt [N/m]
    double stretch;                  // d / (R_i + R_j) [-]
    std::size_t node_i, node_j;
  };
  // Half contact of a cluster: one of its sliding contacts, and its slip back per length of
  // rotation [-].
  struct Side {
    std::size_t cluster, contact;
    double rate;
  };
  // Rotation [m] from which the sum of the contacts' stiffnesses changes by `stiffness` [N/m].
  struct Kink {
    double rotation, stiffness;
  };
  struct Member {
    std::size_t cluster;
    double sense;  // of the rotation, +-1
  };

  Member member(std::size_t node);
  void list_sides();
  [[nodiscard]] double force(std::span<const Side> sides) const;
  double balance(std::span<const Side> sides, double force);

  std::vector<std::size_t> parent_;  // of a node in its cluster's tree; the root is its own parent
  std::vector<double> sense_;        // of rotation relative to the parent, +-1
  std::vector<unsigned char> locked_;  // by odd cycles, at the cluster's root
  std::vector<unsigned char> seen_;    // nodes out of balance
  std::vector<unsigned char> wanted_;  // clusters with such nodes
  std::vector<double> rotation_;       // of a cluster: R theta of its root [m]
  std::vector<Sliding> sliding_;
  std::vector<Side> sides_;  // sorted by clusters
  std::vector<Kink> kinks_;
};

}  // namespace grainlaw::core
