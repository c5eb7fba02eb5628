// The tests of discs name what they use without its dimension.
#pragma once

#include "equilibrium/strategy.hpp"
#include "homogenise/measures.hpp"
#include "state/serialise.hpp"
#include "state/state.hpp"

#include <memory>
#include <utility>

namespace grainlaw::core::test {

using BoundarySpace = grainlaw::core::BoundarySpace<2>;
using Configuration = grainlaw::core::Configuration<2>;
using ContactHistory = grainlaw::core::ContactHistory<2>;
using ContactList = grainlaw::core::ContactList<2>;
using ContactPoint = grainlaw::core::ContactPoint<2>;
using HalfContacts = grainlaw::core::HalfContacts<2>;
using ContactView = grainlaw::core::ContactView<2>;
using ForceRecord = grainlaw::core::ForceRecord<2>;
using HistoryStart = grainlaw::core::HistoryStart<2>;
using Increment = grainlaw::core::Increment<2>;
using LeastMass = grainlaw::core::LeastMass<2>;
using Material = grainlaw::core::Material<2>;
using NeighbourPair = grainlaw::core::NeighbourPair<2>;
using NeighbourSearch = grainlaw::core::NeighbourSearch<2>;
using NewtonMemory = grainlaw::core::NewtonMemory<2>;
using ParticleRecord = grainlaw::core::ParticleRecord<2>;
using Problem = grainlaw::core::Problem<2>;
using Relaxation = grainlaw::core::Relaxation<2>;
using RelaxationMemory = grainlaw::core::RelaxationMemory<2>;
using Request = grainlaw::core::Request<2>;
using RollingMechanisms = grainlaw::core::RollingMechanisms<2>;
using Sensitivity = grainlaw::core::Sensitivity<2>;
using State = grainlaw::core::State<2>;
using Stiffness = grainlaw::core::Stiffness<2>;
using StiffnessRecord = grainlaw::core::StiffnessRecord<2>;
using SubspaceExtrapolation = grainlaw::core::SubspaceExtrapolation<2>;
using TouchingContact = grainlaw::core::TouchingContact<2>;
using Workspace = grainlaw::core::Workspace<2>;

inline std::shared_ptr<const Material> make_material(MaterialDescription description) {
  return grainlaw::core::make_material<2>(std::move(description));
}

}  // namespace grainlaw::core::test
