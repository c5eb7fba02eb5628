// What listed contacts do at the present coordinates: their geometry, load and support.
#pragma once

#include "increment/increment.hpp"

#include <cstddef>
#include <vector>

namespace grainlaw::core {

// Branch x_j - x_i of a listed contact [m].
template <int D>
Vec<D> branch_of(const ForceBalance<D>& balance, std::size_t c) {
  const auto& contacts = balance.contacts();
  const auto n = balance.problem().particles();
  const auto p = static_cast<std::size_t>(contacts.i[c]);
  const auto q = static_cast<std::size_t>(contacts.j[c]);
  Vec<D> l{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(D); ++k) {
    const double* x = balance.motion().coordinates().data() + k * n;
    l[k] = x[q] - x[p] + contacts.offset[k][c];
  }
  return l;
}

// Reference branch X'_j - X'_i of a listed contact, for a space bound to axes [m].
template <int D>
Vec<D> fixed_branch_of(const ForceBalance<D>& balance, std::size_t c) {
  return balance.motion().fixed_branch(balance.contacts().i[c], balance.contacts().j[c]);
}

// True if the contact is open by more than rounding; needs no square root.
template <int D>
bool surely_open(const ForceBalance<D>& balance, std::size_t c) {
  constexpr double more_than_rounding = 1 + 1e-9;
  const double rest = more_than_rounding * balance.contacts().rest_of(c);
  return square<D>(branch_of(balance, c)) > rest * rest && !balance.contacts().bonded(c);
}

// Overlap of a listed contact, negative across a gap [m].
template <int D>
double overlap_of(const ForceBalance<D>& balance, std::size_t c);

// True if the contact is load bearing. Rattlers touch their cage at random with forces of about the
// residual, so ten times the scatter is required.
template <int D>
bool bears_load(const Increment<D>& increment, std::size_t c);

// True if any contact is load bearing, or particles may be by their inertia.
template <int D>
bool loaded(const Increment<D>& increment);

// Finds the directions in which contacts or the boundary support a node, as fixed_bit() of each.
template <int D>
void find_supported(const Increment<D>& increment, std::vector<unsigned char>& supported);

// True if the boundary cannot support a uniform stress: forces are close to zero, or a boundary
// particle has no contact.
template <int D>
bool collapsed(Increment<D>& increment);

// True if the boundary collapsed or no contact is left.
template <int D>
bool lost(Increment<D>& increment);

}  // namespace grainlaw::core
