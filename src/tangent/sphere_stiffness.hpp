// The parts of the stiffness that spheres alone have. Included by stiffness.hpp.
#pragma once

#include "tangent/stiffness.hpp"

namespace grainlaw::core {

template <>
void Stiffness<3>::add_contacts();
template <>
void Stiffness<3>::add_moments();
// A sphere with exactly two contacts spins freely about the chord through its two contact points: held
// with next to nothing, since the stress depends on it by the springs, and is determined only so.
template <>
void Stiffness<3>::hold_free_spins(const Increment<3>& increment);

template <>
void Stiffness<3>::prepare_iteration(Increment<3>& increment);
template <>
bool Stiffness<3>::solve_step(Increment<3>& increment, std::span<const double> b, double forcing,
                              std::span<double> x);
template <>
bool Stiffness<3>::iterate_together(Increment<3>& increment, std::span<const Together<width>> b,
                                    std::span<Together<width>> x);

}  // namespace grainlaw::core
