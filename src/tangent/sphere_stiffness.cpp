// Stiffness of contacts of spheres, as blocks of the nodes they join.
#include "base/capacity.hpp"
#include "base/constants.hpp"
#include "tangent/stiffness.hpp"

#include <algorithm>

namespace grainlaw::core {

namespace {

// Derivatives of a contact's force and spin moment by the spin of one node. Those by its position
// are +- by_branch.
struct Columns {
  Matrix3 force_by_spin, spin_by_spin;
};

Columns by_spin(const TouchingContact<3>& contact, const Matrix3& mean_spin, double lever) {
  Matrix3 share{};
  add(share, lever, mean_spin);
  return {product<3>(contact.stiffness.force_by_rotation, share),
          product<3>(contact.stiffness.spin_by_rotation, share)};
}

// Adds -dr of a row node, whose residual has sign x force and radius x spin moment.
void add_block(BlockColumn<8>* block, double force_sign, double radius, double branch_sign,
               const SphereStiffness& s, const Columns& columns) {
  for (std::size_t c = 0; c < 3; ++c) {
    double* of_position = block[c].lane;
    double* of_spin = block[3 + c].lane;
    for (std::size_t r = 0; r < 3; ++r) {
      of_position[r] -= force_sign * branch_sign * s.force_by_branch[3 * r + c];
      of_position[3 + r] -= radius * branch_sign * s.spin_by_branch[3 * r + c];
      of_spin[r] -= force_sign * columns.force_by_spin[3 * r + c];
      of_spin[3 + r] -= radius * columns.spin_by_spin[3 * r + c];
    }
  }
}

}  // namespace

template <>
void Stiffness<3>::add_contacts() {
  const std::size_t edges = matrix_.edges.size();
  for (const auto& contact : touching_) {
    const std::size_t i = contact.node_i;
    const std::size_t j = contact.node_j;
    const std::int32_t edge = edge_of_contact_[contact.index];
    const std::size_t upper = edge < 0 ? i : matrix_.upper(static_cast<std::size_t>(edge));
    const std::size_t lower = edge < 0 ? i : upper + edges;
    const Columns spin_i = by_spin(contact, contact.point.spin_i, contact.lever_i);
    const Columns spin_j = by_spin(contact, contact.point.spin_j, 1 - contact.lever_i);
    const double radius_i = contact.lever_i * contact.reach;
    const double radius_j = (1 - contact.lever_i) * contact.reach;
    const auto& s = contact.stiffness;
    add_block(matrix_.block(i), -1, radius_i, -1, s, spin_i);
    add_block(matrix_.block(i < j ? upper : lower), -1, radius_i, 1, s, spin_j);
    add_block(matrix_.block(i < j ? lower : upper), 1, radius_j, -1, s, spin_i);
    add_block(matrix_.block(j), 1, radius_j, 1, s, spin_j);
  }
}

// Adds -dr of the moments: m on j and -m on i.
template <>
void Stiffness<3>::add_moments() {
  const std::size_t edges = matrix_.edges.size();
  const auto add_to = [](BlockColumn<8>* block, double sign, const Matrix3& by_position,
                         const Matrix3& by_spin, double branch_sign) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t r = 0; r < 3; ++r) {
        block[c].lane[3 + r] -= sign * branch_sign * by_position[3 * r + c];
        block[3 + c].lane[3 + r] -= sign * by_spin[3 * r + c];
      }
    }
  };
  for (std::size_t k = 0; k < touching_.size(); ++k) {
    const auto& moment = moments_[k];
    const std::size_t i = touching_[k].node_i;
    const std::size_t j = touching_[k].node_j;
    const std::int32_t edge = edge_of_contact_[touching_[k].index];
    const std::size_t upper = edge < 0 ? i : matrix_.upper(static_cast<std::size_t>(edge));
    const std::size_t lower = edge < 0 ? i : upper + edges;
    add_to(matrix_.block(i), -1, moment.by_branch, moment.by_spin_i, -1);
    add_to(matrix_.block(i < j ? upper : lower), -1, moment.by_branch, moment.by_spin_j, 1);
    add_to(matrix_.block(i < j ? lower : upper), 1, moment.by_branch, moment.by_spin_i, -1);
    add_to(matrix_.block(j), 1, moment.by_branch, moment.by_spin_j, 1);
  }
}

// Adds the springs to the rows of spins, in the columns of the sphere and its neighbours too.
template <>
void Stiffness<3>::add_chord_springs(const Increment<3>& increment) {
  const std::size_t edges = matrix_.edges.size();
  const auto add_to = [](BlockColumn<8>* columns, double factor, const Vec<3>& moment,
                         const Vec<3>& by) {
    for (std::size_t l = 0; l < 3; ++l) {
      for (std::size_t k = 0; k < 3; ++k) columns[l].lane[3 + k] += factor * moment[k] * by[l];
    }
  };
  for (const auto& sphere : increment.two_contact_spheres().spheres()) {
    auto* const own = matrix_.block(sphere.node);
    const auto add_to_neighbour = [&](std::size_t contact, std::size_t neighbour, double factor,
                                      const Vec<3>& by) {
      const std::int32_t edge = edge_of_contact_[contact];
      if (edge == not_in_graph) return;
      const std::size_t upper =
          edge < 0 ? sphere.node : matrix_.upper(static_cast<std::size_t>(edge));
      const bool above = edge < 0 || sphere.node < neighbour;
      add_to(matrix_.block(above ? upper : upper + edges), factor * sphere.stiffness, sphere.chord,
             by);
    };
    if (sphere.stopped()) {
      add_to(own, -sphere.stiffness, sphere.chord, sphere.by_third);
      add_to_neighbour(sphere.third, sphere.third_neighbour, 1, sphere.by_third);
      continue;
    }
    add_to(own + 3, sphere.stiffness, sphere.chord, sphere.by_spin);
    add_to(own, -sphere.stiffness, sphere.chord, sphere.way);
    for (std::size_t k = 0; k < 2; ++k) {
      add_to_neighbour(sphere.contact[k], sphere.neighbour[k], 0.5, sphere.way);
    }
  }
}

}  // namespace grainlaw::core
