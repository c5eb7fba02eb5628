#include "reference/local_damping.hpp"

#include "contact/contact_point.hpp"
#include "packing/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

// Masses and moments of inertia, summed over the particles of a node (component-major).
template <int D>
void physical_masses(const Increment<D>& increment, std::vector<double>& mass) {
  const Problem<D>& problem = increment.problem();
  const auto& packing = *problem.packing;
  const auto m = problem.nodes();
  mass.assign(problem.unknowns(), 0.0);
  for (std::size_t p = 0; p < packing.size(); ++p) {
    const auto q = static_cast<std::size_t>(problem.space->node[p]);
    const double r = packing.radius[p];
    const double own = particle_mass<D>(packing.density, r, packing.thickness);
    for (std::size_t k = 0; k < D; ++k) mass[k * m + q] += own;
    if (!problem.law->rotating()) continue;
    for (std::size_t k = D; k < Dimension<D>::unknowns; ++k)
      mass[k * m + q] += inertia_share<D> * own * r * r;
  }
}

// Masses of the found components of F, as stable at time step dt as those of the relaxation are at
// step 1.
template <int D>
void mass_of_deformation(const Increment<D>& increment, double dt, std::vector<double>& mass) {
  const auto pseudo_mass = increment.masses().of_unknowns();
  for (std::size_t k = increment.problem().node_unknowns(); k < mass.size(); ++k) {
    mass[k] = dt * dt * pseudo_mass[k];
  }
}

// Critical time step of the lightest particle on its stiffest contact, min sqrt(m / kn) [s].
template <int D>
double critical_step(const Increment<D>& increment) {
  const auto& packing = *increment.problem().packing;
  double smallest = 1e300;
  for (const double r : packing.radius) {
    const double own = particle_mass<D>(packing.density, r, packing.thickness);
    smallest = std::min(smallest, own / increment.problem().law->largest_stiffness(r, r));
  }
  return std::sqrt(smallest);
}

// Ek / Ep of eqs. 11-12; Ep uses the elastic part of the tangential displacement.
template <int D>
double energy_ratio(const Increment<D>& increment, const std::vector<double>& mass,
                    const std::vector<double>& velocity) {
  double kinetic = 0;
  for (std::size_t k = 0; k < velocity.size(); ++k) {
    kinetic += 0.5 * mass[k] * velocity[k] * velocity[k];
  }
  const double potential = stored_energy(increment.contacts(), increment.motion().coordinates(),
                                         increment.problem().particles(), *increment.problem().law);
  return kinetic / std::max(potential, 1e-300);
}

}  // namespace

template <int D>
bool relax_published(Increment<D>& increment, double tolerance, const PublishedOptions& options,
                     std::span<const unsigned char> frozen, ReferenceMemory& memory) {
  constexpr long check_interval = 20;
  const Problem<D>& problem = increment.problem();
  const auto& space = *problem.space;
  const std::size_t size = problem.unknowns();
  const std::size_t nodes = problem.nodes();
  const auto is_frozen = [&](std::size_t k) {
    if (frozen.empty()) return false;
    return k >= problem.node_unknowns() || (frozen[k % nodes] >> (k / nodes) & 1U) != 0;
  };
  auto& mass = memory.mass;
  physical_masses(increment, mass);
  memory.velocity.assign(size, 0.0);
  double* v = memory.velocity.data();
  const double dt = options.time_step_ratio * critical_step(increment);

  double last_ratio = 0;
  bool fallen = false;
  for (long step = 0; step < options.max_steps; ++step) {
    increment.update_forces(History::advancing);
    const double* r = increment.residual().data();
    if (step % check_interval == 0) {
      increment.advance_history();
      increment.keep_neighbours();
      increment.refresh_masses();
      increment.update_forces(History::advancing);
      if (space.finds_deformation) mass_of_deformation(increment, dt, mass);
      double largest = 0;
      for (std::size_t k = 0; k < size; ++k) {
        if (is_frozen(k)) continue;
        const bool rotation = k >= D * nodes && k < problem.node_unknowns();
        const double lever = !rotation ? 1.0 : increment.motion().node_radius()[k % nodes];
        largest = std::max(largest, std::abs(r[k]) / lever);
      }
      if (increment.scale().touching() == 0 || !std::isfinite(largest)) return false;
      if (largest < tolerance * increment.scale().relative()) return true;
      if (options.energy_tolerance > 0) {
        const double ratio = energy_ratio(increment, mass, memory.velocity);
        fallen = fallen || ratio < last_ratio;
        if (fallen && ratio <= options.energy_tolerance) return true;
        last_ratio = ratio;
      }
    }
    for (std::size_t k = 0; k < size; ++k) {
      const double damped = r[k] - options.damping * std::copysign(std::abs(r[k]), v[k]);
      v[k] += dt * (v[k] != 0 ? damped : r[k]) / mass[k];
    }
    if (!frozen.empty()) {
      for (std::size_t k = 0; k < size; ++k) {
        if (is_frozen(k)) v[k] = 0;
      }
    } else if (space.averages()) {
      if constexpr (D == 2)
        AverageMasses::project_out_velocity(space, nodes, memory.velocity, mass);
    }
    increment.motion().move(memory.velocity, dt);
    ++increment.cost.relaxation_steps;
  }
  return false;
}

template bool relax_published(Increment<2>&, double, const PublishedOptions&,
                              std::span<const unsigned char>, ReferenceMemory&);
template bool relax_published(Increment<3>&, double, const PublishedOptions&,
                              std::span<const unsigned char>, ReferenceMemory&);

}  // namespace grainlaw::core
