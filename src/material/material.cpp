#include "material/material.hpp"

#include "base/error.hpp"
#include "equilibrium/strategy.hpp"
#include "frame/frame.hpp"
#include "generate/compaction.hpp"
#include "homogenise/stress.hpp"
#include "increment/contact_state.hpp"
#include "material/given_contacts.hpp"
#include "material/initial_stress.hpp"
#include "material/space_of.hpp"
#include "material/start_advice.hpp"
#include "packing/geometry.hpp"
#include "packing/row_order.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainlaw::core {

namespace {

// Configuration of the packing as given, contacts in the order of the neighbours.
template <int D>
Configuration<D> given_configuration(const Material<D>& material) {
  const auto& packing = material.packing;
  const auto n = packing.size();
  Configuration<D> given;
  given.deformation = identity<D>();
  given.coordinates = packing.position;
  if (material.law.rotating()) append_zero_rotations<D>(n, given.coordinates);
  for (const auto& contact : packing.contacts) {
    ContactHistory<D> history;
    const bool swapped = is_named_from_j(contact);
    history.i = swapped ? contact.j : contact.i;
    history.j = swapped ? contact.i : contact.j;
    for (std::size_t k = 0; k < D; ++k) {
      history.shift[k] = static_cast<std::int16_t>(swapped ? -contact.shift[k] : contact.shift[k]);
    }
    history.tangential_force = given_force<D>(packing, contact);
    given.contacts.push_back(history);
  }
  std::sort(given.contacts.begin(), given.contacts.end(),
            [](const auto& a, const auto& b) { return key_of(a) < key_of(b); });
  if (material.law.moments() || material.law.bonds()) add_bonds_and_moments(material, given);
  return given;
}

// Fails unless the given contact forces are those of this law. Forces of another stiffness would
// silently start from another equilibrium.
template <int D>
void check_given_forces(const Material<D>& material) {
  constexpr double tolerance = 0.01;
  const auto& packing = material.packing;
  const ContactLaw &law = material.law, of_bonds = law.of_bonds();
  const double most_shear = std::max(100.0, law.friction);  // relative to the normal
                                                            // forces
  double given = 0, found = 0, shear = 0;
  for (const auto& contact : packing.contacts) {
    const auto i = static_cast<std::size_t>(contact.i);
    const auto j = static_cast<std::size_t>(contact.j);
    const double overlap = given_overlap<D>(packing, contact);
    const bool pulls = contact.bonded && law.bonds();
    const bool bonded = law.bonds() && (contact.bonded || !packing.names_bonds);
    const auto carried = [&](double value) {
      return pulls ? std::abs(value) : std::max(value, 0.0);
    };
    given += carried(contact.normal_force);
    if (!pulls) shear += length<3>(contact.tangential_force);
    found += (bonded ? of_bonds : law)
                 .normal_force(packing.radius[i], packing.radius[j],
                               carried(overlap + contact.bond_gap));
  }
  if (given > 0 && std::abs(found - given) > tolerance * given) {
    throw Error(
        GRAINLAW_BAD_PACKING,
        fmt::format("packing.contacts: its normal forces add up to {:.6g} N, but overlaps and "
                    "stiffness of [contact] give {:.6g} N; expected the same within 1 %: the "
                    "stiffness the packing was made with, or no packing.contacts",
                    given, found));
  }
  if (shear > most_shear * given)
    throw Error(
        GRAINLAW_BAD_PACKING,
        fmt::format(
            "packing.contacts: tangential forces add up to {:.6g} N, normal ones to {:.6g} N; "
            "expected at most {:g} times as much",
            shear, given, most_shear));
}

// Mean normal force as given; a boundary under uniform stress may have no other to start from.
template <int D>
double force_as_given(const Problem<D>& problem, const Configuration<D>& given,
                      Workspace<D>& workspace) {
  workspace.increment.begin(problem, given, identity<D>());
  workspace.increment.refresh_masses();
  return workspace.increment.scale().mean_force();
}

template <int D>
std::uint64_t fingerprint_of(const Material<D>& material) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  const auto add = [&](const void* data, std::size_t size) {
    XXH3_64bits_update(&state, data, size);
  };
  const auto add_all = [&](const std::vector<double>& values) {
    add(values.data(), values.size() * sizeof(double));
  };
  const auto& of = material.law;
  const double law[] = {static_cast<double>(of.kind),
                        of.young,
                        of.normal_stiffness,
                        of.ratio,
                        of.friction,
                        of.rotation ? 1.0 : 0.0,
                        of.shear_modulus,
                        of.poisson,
                        of.rolling.ratio,
                        of.rolling.friction,
                        of.bond.normal_strength,
                        of.bond.tangential_strength,
                        of.bond.bending_strength,
                        of.bond.bending_stiffness,
                        of.bond.gap,
                        material.packing.thickness};
  const int boundary[] = {static_cast<int>(material.space.options.type),
                          static_cast<int>(material.space.options.weight)};
  add(law, sizeof law);
  if constexpr (D == 3) {
    const double moments[] = {of.rolling.twisting_ratio, of.rolling.twisting_friction,
                              of.bond.torsion_strength, of.bond.torsion_stiffness};
    add(moments, sizeof moments);
  }
  if (of.bond.normal_stiffness > 0) {
    const double springs[] = {of.bond.normal_stiffness, of.bond.tangential_stiffness};
    add(springs, sizeof springs);
  }
  add(boundary, sizeof boundary);
  if (material.space.options.type == BoundaryType::mixed) {
    for (const Side& side : material.space.options.sides) {
      const int rules[] = {static_cast<int>(side.x), static_cast<int>(side.y),
                           static_cast<int>(side.rotation), static_cast<int>(side.row)};
      add(rules, sizeof rules);
    }
  }
  if (material.space.options.inner_rotation == InnerRotation::fixed) add("inner", 5);
  // Both save velocities, of different things.
  if (material.solver.viscosity.number > 0) add("drag", 4);
  if (material.solver.inertia) {
    add("inertia", 7);
    add(&material.packing.density, sizeof material.packing.density);
  }
  add(material.packing.cell.data(), sizeof material.packing.cell);
  add_all(material.packing.radius);
  add_all(material.packing.position);
  return XXH3_64bits_digest(&state);
}

// Cuts a frame for a frame condition whose packing has none.
template <int D>
void fit_frame(const BoundaryOptions& boundary, Packing& packing) {
  if (boundary.type == BoundaryType::periodic_cell) {
    if (packing.frame) {
      throw Error(GRAINLAW_BAD_PACKING,
                  "the packing is a frame; expected a periodic packing, or boundary.type = "
                  "\"frame-p\", \"frame-d\", \"frame-t\" or \"mixed\"");
    }
  } else if (!packing.frame) {
    packing = cut_frame(packing);
  }
}

// Fails for a gap so long that each particle would be bonded to all around it.
void check_bond_gap(const ContactLaw& law, const Packing& packing) {
  if (!law.bonds() || packing.radius.empty()) return;
  const double diameter = 2 * *std::ranges::max_element(packing.radius);
  if (law.bond.gap <= diameter) return;
  throw Error(GRAINLAW_BAD_MATERIAL,
              fmt::format("contact.bond.gap: found {}, expected at most the largest diameter, {}",
                          law.bond.gap, diameter));
}

}  // namespace

template <int D>
std::shared_ptr<const Material<D>> make_material(MaterialDescription description) {
  if (description.generator) {
    description.packing = consolidate<D>(*description.generator, description.law.of_bonds());
  }
  auto material = std::make_shared<Material<D>>();
  material->packing = std::move(description.packing);
  material->law = description.law;
  material->solver = description.solver;
  check_bond_gap(material->law, material->packing);
  fit_frame<D>(description.boundary, material->packing);
  material->packing.order = row_order(material->packing);
  material->space = space_of<D>(material->packing, description.boundary);
  material->fingerprint = fingerprint_of(*material);
  check_given_forces(*material);

  if (material->law.hertzian()) material->law.typical_overlap = mean_overlap(*material);
  const double unloaded_force = unloaded_force_scale(*material);
  const double least_force = material->law.bonds() ? unloaded_force : 0;
  const bool may_be_free = material->solver.contacts_lost == ContactsLost::stress_free;
  // Every method, servo and published relaxation too, starts from the direct equilibrium.
  constexpr double tightest_needed = 1e-8;
  BoundarySpace<D> direct = material->space;
  direct.options.method = BoundaryMethod::direct;
  direct.finds_deformation = false;
  direct.found = {};
  SolverOptions options = material->solver;
  options.method = Method::direct;
  options.viscosity.number = 0;
  const double tolerance = std::min(options.tolerance, tightest_needed);
  Problem<D> problem{&material->packing, &material->law, &direct,
                     relative_floor * (may_be_free ? unloaded_force : least_force), tolerance};
  const Configuration<D> given = given_configuration(*material);
  Request<D> request{&problem, &options, &given, identity<D>()};
  request.tolerance = tolerance;
  request.trying = Trying::whole;
  Workspace<D> workspace;
  if (direct.averages()) {
    problem.force_floor =
        std::max(problem.force_floor, relative_floor * force_as_given(problem, given, workspace));
  }
  const auto outcome = solve(request, workspace);
  const bool free = outcome.status == GRAINLAW_OK && !loaded(workspace.increment);
  if (outcome.status == GRAINLAW_CONTACTS_LOST || (free && !may_be_free)) {
    throw Error(GRAINLAW_CONTACTS_LOST,
                "the packing has no contacts at F = I; expected one that carries stress, or "
                "solver.contacts_lost = \"stress_free\"");
  }
  if (outcome.status == GRAINLAW_COLLAPSED) {
    const int released = workspace.increment.released_particle();
    throw Error(
        outcome.status,
        fmt::format("the packing carries no uniform stress at F = I: {}; expected every "
                    "boundary particle under \"T\" to be held by others",
                    released < 0 ? "the forces vanish"
                                 : fmt::format("boundary particle {} (from 0, as written) has "
                                               "no contact",
                                               released)));
  }
  if (outcome.status != GRAINLAW_OK && workspace.increment.scale().below_rounding()) {
    throw Error(outcome.status,
                fmt::format("contacts carry no more at F = I than rounding makes of "
                            "them; {}",
                            start_advice(workspace.increment, description)));
  }
  if (outcome.status != GRAINLAW_OK) {
    throw Error(
        outcome.status,
        fmt::format("the packing found no equilibrium at F = I: residual "
                    "{:.3g} after {} relaxation steps, expected {:.3g}; {}",
                    workspace.increment.residual_norm(), workspace.increment.cost.relaxation_steps,
                    request.tolerance, start_advice(workspace.increment, description)));
  }
  const auto stress = free ? Tensor<D>{} : piola_stress(workspace.increment);
  workspace.increment.advance_history();
  workspace.increment.export_to(given, material->initial);
  material->initial.stress = stress;
  material->initial.dissipated = material->initial.broken_bonds = 0;
  material->initial_mean_force =
      free ? unloaded_force : std::max(workspace.increment.scale().mean_force(), least_force);
  if (material->space.finds_deformation) {
    problem.force_floor = relative_floor * material->initial_mean_force;
    load_to_stress(material->space, request, workspace, material->initial);
    material->initial_mean_force = std::max(workspace.increment.scale().mean_force(), least_force);
  }
  return material;
}

template std::shared_ptr<const Material<2>> make_material(MaterialDescription);
template std::shared_ptr<const Material<3>> make_material(MaterialDescription);

}  // namespace grainlaw::core
