// Stiffness of spheres; included by stiffness.hpp.
#pragma once

#include "tangent/stiffness.hpp"

namespace grainlaw::core {

template <>
void Stiffness<3>::add_contacts();
template <>
void Stiffness<3>::add_moments();
// Adds the springs about the chords of two-contact spheres. Their small stiffness decides a
// rotation that equilibrium leaves open but P depends on. @formula free-spin
template <>
void Stiffness<3>::add_chord_springs(const Increment<3>& increment);

template <>
void Stiffness<3>::prepare_iteration(Increment<3>& increment);
template <>
bool Stiffness<3>::solve_step(Increment<3>& increment, std::span<const double> b, double forcing,
                              std::span<double> x);
template <>
bool Stiffness<3>::iterate_together(Increment<3>& increment, std::span<const Together<width>> b,
                                    std::span<Together<width>> x);

}  // namespace grainlaw::core
