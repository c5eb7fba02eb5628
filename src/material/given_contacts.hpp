// Initial histories of the contacts given with a packing, or made for it.
#pragma once

#include "increment/configuration.hpp"
#include "material/material.hpp"
#include "packing/geometry.hpp"

namespace grainlaw::core {

// x_j - x_i + H shift in the packing as given [m].
template <int D, class Pair>
Vec<D> given_branch(const Packing& packing, const Pair& pair) {
  const Tensor<D> cell = packing.frame ? Tensor<D>{} : tensor_of<D>(packing.cell);
  return branch<D>(packing.position.data(), packing.size(), static_cast<std::size_t>(pair.i),
                   static_cast<std::size_t>(pair.j), cell, vec_of<D>(pair.shift));
}

// Overlap R_i + R_j - |branch| in the packing as given [m].
template <int D, class Pair>
double given_overlap(const Packing& packing, const Pair& pair) {
  return packing.radius[static_cast<std::size_t>(pair.i)] +
         packing.radius[static_cast<std::size_t>(pair.j)] -
         length<D>(given_branch<D>(packing, pair));
}

// Whether a file names a contact from j. Branch, normal, tangent and force are then reversed; the
// component along the tangent of discs stays.
inline bool is_named_from_j(const InitialContact& contact) {
  constexpr std::array<int, 3> none{};
  return contact.i > contact.j || (contact.i == contact.j && contact.shift < none);
}

// Force and moment on j of a given contact, laid out as in ContactHistory [N, N m].
template <int D>
std::array<double, Dimension<D>::tangents> given_force(const Packing& packing,
                                                       const InitialContact& contact);
template <int D>
std::array<double, Dimension<D>::spins> given_moment(const InitialContact& contact);

// Bonds pairs that touch or are nearer than the gap, unless the packing names its bonds, and sets
// initial moments. `given` has the packing's contacts in the order of the neighbours.
template <int D>
void add_bonds_and_moments(const Material<D>& material, Configuration<D>& given);

// Mean overlap of touching particles over their common radius; 1e-3 when none touch by more than
// rounding [-].
template <int D>
double mean_overlap(const Material<D>& material);

// Force scale of residuals in a packing without forces at F = I: kn times a thousandth of the mean
// radius [N].
template <int D>
double unloaded_force_scale(const Material<D>& material);

}  // namespace grainlaw::core
