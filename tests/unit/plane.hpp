// The tests of discs name what they use without its dimension.
#pragma once

#include "equilibrium/strategy.hpp"
#include "homogenise/measures.hpp"
#include "state/serialise.hpp"
#include "state/state.hpp"

#include <memory>
#include <utility>

namespace grainlaw::test {

using BoundarySpace = grainlaw::BoundarySpace<2>;
using Configuration = grainlaw::Configuration<2>;
using ContactHistory = grainlaw::ContactHistory<2>;
using ContactList = grainlaw::ContactList<2>;
using ContactPoint = grainlaw::ContactPoint<2>;
using ContactSides = grainlaw::ContactSides<2>;
using ContactView = grainlaw::ContactView<2>;
using ForceRecord = grainlaw::ForceRecord<2>;
using HistoryStart = grainlaw::HistoryStart<2>;
using Increment = grainlaw::Increment<2>;
using LeastMass = grainlaw::LeastMass<2>;
using Material = grainlaw::Material<2>;
using NeighbourPair = grainlaw::NeighbourPair<2>;
using NeighbourSearch = grainlaw::NeighbourSearch<2>;
using NewtonMemory = grainlaw::NewtonMemory<2>;
using ParticleRecord = grainlaw::ParticleRecord<2>;
using Problem = grainlaw::Problem<2>;
using Relaxation = grainlaw::Relaxation<2>;
using RelaxationMemory = grainlaw::RelaxationMemory<2>;
using Request = grainlaw::Request<2>;
using RollingMechanisms = grainlaw::RollingMechanisms<2>;
using Sensitivity = grainlaw::Sensitivity<2>;
using State = grainlaw::State<2>;
using Stiffness = grainlaw::Stiffness<2>;
using StiffnessRecord = grainlaw::StiffnessRecord<2>;
using SubspaceExtrapolation = grainlaw::SubspaceExtrapolation<2>;
using TouchingContact = grainlaw::TouchingContact<2>;
using Workspace = grainlaw::Workspace<2>;

inline std::shared_ptr<const Material> make_material(MaterialDescription description) {
  return grainlaw::make_material<2>(std::move(description));
}

}  // namespace grainlaw::test
