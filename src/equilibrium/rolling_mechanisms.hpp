// Rolling mechanisms: discs that roll on each other like gears, which stiffness and friction leave free
// to.
#pragma once

#include "increment/increment.hpp"
#include "tangent/stiffness.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// A cluster of discs that stick to each other alone, in even cycles or none, while they slide on
// all others, can turn without that any force changes: its stiffness against that is zero. Most are in
// balance with the forces on them whatever their rotation; where one is not, its moment leads a
// Newton step far away and a relaxation nowhere soon, until it has turned so far that a contact
// sticks again.
template <int D>
class RollingMechanisms;

template <>
class RollingMechanisms<2> {
 public:
  // Of discs that are nodes of their own, whose contacts have no moments.
  static bool possible(const Problem<2>& problem);

  // Of the contacts that touch at the present coordinates.
  void find(const Increment<2>& increment, std::span<const TouchingContact<2>> touching);
  // Add stiffness against turning to one disc of every cluster.
  void hold(const Increment<2>& increment, Stiffness<2>& stiffness) const;
  // Which of them took more than `least` [N] on the surface to be held in a step: what no other
  // motion balances. Until they have turned or the next step.
  void see(const Increment<2>& increment, std::span<const double> step, double least);
  void forget(const Increment<2>& increment);
  // Turn the clusters with one of these, where their moment is more than `least` [N], to where it
  // vanishes, in its coordinates. Returns whether any was turned: then find() them anew.
  bool turn(Increment<2>& increment, double least);

 private:
  struct Sliding {
    double trial, bound, stiffness;  // the spring's force, how much of it is carried [N]; kt [N/m]
    double stretch;                  // distance / (R_i + R_j) [-]
    std::size_t node_i, node_j;
  };
  // One of its sliding contacts, and by how much they slip back as it turns by a length.
  struct Side {
    std::size_t cluster, contact;
    double rate;
  };
  // From where on, in a turn, the sum of the contacts' stiffnesses changes by so much.
  struct Kink {
    double turn, stiffness;
  };
  struct Member {
    std::size_t cluster;
    double sense;  // of its rotation, +-1
  };

  Member member(std::size_t node);
  void list_sides();
  [[nodiscard]] double force(std::span<const Side> sides) const;
  double balance(std::span<const Side> sides, double force);

  std::vector<std::size_t> parent_;    // of a node in its cluster's tree; itself: it stands for it
  std::vector<double> sense_;          // against the parent's
  std::vector<unsigned char> locked_;  // by odd cycles: the cluster of this node
  std::vector<unsigned char> seen_;    // out of balance, by nodes
  std::vector<unsigned char> wanted_;  // the clusters of these
  std::vector<double> turn_;           // of a cluster: R theta of what stands for it [m]
  std::vector<Sliding> sliding_;
  std::vector<Side> sides_;  // by clusters
  std::vector<Kink> kinks_;
};

}  // namespace grainlaw::core
