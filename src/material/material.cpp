#include "material/material.hpp"

#include "base/error.hpp"
#include "equilibrium/strategy.hpp"
#include "frame/frame.hpp"
#include "frame/frame_space.hpp"
#include "generate/compaction.hpp"
#include "homogenise/stress.hpp"
#include "material/given_contacts.hpp"
#include "material/initial_stress.hpp"
#include "packing/row_order.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace grainlaw {

namespace {

// The packing as it is given, in the order in which neighbours are listed.
Configuration given_configuration(const Material& material) {
  const auto& packing = material.packing;
  const auto n = packing.size();
  Configuration given;
  given.deformation = {1, 0, 0, 1};
  given.coordinates = packing.position;
  if (material.law.rotating()) given.coordinates.resize(3 * n, 0.0);
  for (const auto& contact : packing.contacts) {
    ContactHistory history;
    // Seen from the other side branch, normal, tangent and force all turn round; the component
    // stays.
    const bool turn = contact.i > contact.j || (contact.i == contact.j && contact.shift[0] < 0) ||
                      (contact.i == contact.j && contact.shift[0] == 0 && contact.shift[1] < 0);
    history.i = turn ? contact.j : contact.i;
    history.j = turn ? contact.i : contact.j;
    for (std::size_t k = 0; k < 2; ++k) {
      history.shift[k] = static_cast<std::int16_t>(turn ? -contact.shift[k] : contact.shift[k]);
    }
    const auto i = static_cast<std::size_t>(contact.i);
    const auto j = static_cast<std::size_t>(contact.j);
    const auto& h = packing.cell;
    const double s0 = packing.frame ? 0 : contact.shift[0];
    const double s1 = packing.frame ? 0 : contact.shift[1];
    const double lx = packing.position[j] - packing.position[i] + h[0] * s0 + h[1] * s1;
    const double ly = packing.position[n + j] - packing.position[n + i] + h[2] * s0 + h[3] * s1;
    const double d = std::hypot(lx, ly);
    history.tangential_force =
        (-ly * contact.tangential_force[0] + lx * contact.tangential_force[1]) / d;
    given.contacts.push_back(history);
  }
  std::sort(given.contacts.begin(), given.contacts.end(), [](const auto& a, const auto& b) {
    return std::tie(a.i, a.j, a.shift) < std::tie(b.i, b.j, b.shift);
  });
  if (material.law.moments() || material.law.bonds()) add_bonds_and_moments(material, given);
  return given;
}

// Contact forces in the files must be those of this law: a packing made with another stiffness
// would start from another equilibrium without a word.
void check_given_forces(const Material& material) {
  constexpr double tolerance = 0.01;
  const auto& packing = material.packing;
  const auto n = packing.size();
  double given = 0;
  double found = 0;
  for (const auto& contact : packing.contacts) {
    const auto i = static_cast<std::size_t>(contact.i);
    const auto j = static_cast<std::size_t>(contact.j);
    const auto& h = packing.cell;
    const double s0 = packing.frame ? 0 : contact.shift[0];
    const double s1 = packing.frame ? 0 : contact.shift[1];
    const double lx = packing.position[j] - packing.position[i] + h[0] * s0 + h[1] * s1;
    const double ly = packing.position[n + j] - packing.position[n + i] + h[2] * s0 + h[3] * s1;
    const double overlap = packing.radius[i] + packing.radius[j] - std::hypot(lx, ly);
    const bool pulls = contact.bonded && material.law.bonds();
    const auto carried = [&](double value) {
      return pulls ? std::abs(value) : std::max(value, 0.0);
    };
    given += carried(contact.normal_force);
    found += material.law.normal_force(packing.radius[i], packing.radius[j],
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
}

// Mean normal force of the packing as it is given: without it, a boundary under uniform stress could
// begin without any.
double force_as_given(const Problem& problem, const Configuration& given, Workspace& workspace) {
  workspace.increment.begin(problem, given, {1, 0, 0, 1});
  workspace.increment.refresh_masses();
  return workspace.increment.mean_force;
}

double mean_radius(const Packing& packing) {
  double sum = 0;
  for (const double r : packing.radius) sum += r / static_cast<double>(packing.size());
  return sum;
}

// What a packing without an equilibrium is like, and what to look at first.
std::string unsettled(const Increment& increment) {
  constexpr double soft = 30, stiff = 1e7;  // kn / p that are hardly meant
  const Packing& packing = *increment.problem->packing;
  const double r = mean_radius(packing);
  const double kn = increment.problem->law->stiffness(r, r);
  const auto stress = piola_stress(increment);
  const double pressure = -0.5 * (stress[0] + stress[3]);
  const double ratio = kn / (pressure * packing.thickness);
  std::string text = fmt::format("mean pressure {:.3g} Pa, kn {:.3g} N/m", pressure, kn);
  if (!(pressure > 0)) return text + ": it does not bear; expected a denser packing";
  text += fmt::format(", kn/p {:.3g}", ratio);
  if (ratio < soft) return text + ", soft: expected stiffer contacts or smaller overlaps";
  if (ratio > stiff) return text + ", stiff: expected softer contacts or a packing under more load";
  return text + "; expected a packing made with these contacts and friction, and its contacts file";
}

std::uint64_t fingerprint_of(const Material& material) {
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
  add(boundary, sizeof boundary);
  if (material.space.options.type == BoundaryType::mixed) {
    for (const Side& side : material.space.options.sides) {
      const int rules[] = {static_cast<int>(side.x), static_cast<int>(side.y),
                           static_cast<int>(side.rotation), static_cast<int>(side.row)};
      add(rules, sizeof rules);
    }
  }
  add(material.packing.cell.data(), sizeof material.packing.cell);
  add_all(material.packing.radius);
  add_all(material.packing.position);
  return XXH3_64bits_digest(&state);
}

}  // namespace

std::shared_ptr<const Material> make_material(MaterialDescription description) {
  if (description.generator) {
    description.packing = consolidate(*description.generator, description.law);
  }
  auto material = std::make_shared<Material>();
  material->packing = std::move(description.packing);
  material->law = description.law;
  material->solver = description.solver;
  if (description.boundary.type == BoundaryType::periodic_cell) {
    if (material->packing.frame) {
      throw Error(GRAINLAW_BAD_PACKING,
                  "the packing is a frame; expected a periodic packing, or boundary.type = "
                  "\"frame-p\", \"frame-d\", \"frame-t\" or \"mixed\"");
    }
  } else if (!material->packing.frame) {
    material->packing = cut_frame(material->packing);
  }
  material->packing.order = row_order(material->packing);
  material->space = make_boundary_space(material->packing, description.boundary);
  material->fingerprint = fingerprint_of(*material);
  check_given_forces(*material);

  if (material->law.hertzian()) material->law.typical_overlap = mean_overlap(*material);
  const double unloaded_force = unloaded_force_scale(*material);
  const double least_force = material->law.bonds() ? unloaded_force : 0;
  const bool may_be_free = material->solver.contacts_lost == ContactsLost::stress_free;
  // The servo and the published relaxation start from the same equilibrium as everything else.
  constexpr double tightest_needed = 1e-8;
  BoundarySpace direct = material->space;
  direct.options.method = BoundaryMethod::direct;
  direct.finds_deformation = false;
  direct.found = {};
  SolverOptions options = material->solver;
  options.method = Method::chain;
  const double tolerance = std::min(options.tolerance, tightest_needed);
  Problem problem{&material->packing, &material->law, &direct,
                  relative_floor * (may_be_free ? unloaded_force : least_force), tolerance};
  const Configuration given = given_configuration(*material);
  Request request{&problem, &options, &given, {1, 0, 0, 1}};
  request.tolerance = tolerance;
  Workspace workspace;
  if (direct.averages()) {
    problem.force_floor =
        std::max(problem.force_floor, relative_floor * force_as_given(problem, given, workspace));
  }
  const auto outcome = solve(request, workspace);
  const bool free = outcome.status == GRAINLAW_OK && !workspace.increment.bears();
  if (outcome.status == GRAINLAW_CONTACTS_LOST || (free && !may_be_free)) {
    throw Error(GRAINLAW_CONTACTS_LOST,
                "the packing has no contacts at F = I; expected one that carries stress, or "
                "solver.contacts_lost = \"stress_free\"");
  }
  if (outcome.status == GRAINLAW_COLLAPSED) {
    const int let_go = workspace.increment.released_particle();
    throw Error(
        outcome.status,
        fmt::format("the packing carries no uniform stress at F = I: {}; expected every "
                    "boundary particle under \"T\" to be held by others",
                    let_go < 0 ? "the forces vanish"
                               : fmt::format("boundary particle {} (from 0, as written) has "
                                             "no contact",
                                             let_go)));
  }
  if (outcome.status != GRAINLAW_OK) {
    throw Error(outcome.status, fmt::format("the packing found no equilibrium at F = I: residual "
                                            "{:.3g} after {} relaxation steps, expected {:.3g}; {}",
                                            workspace.increment.residual_norm(),
                                            workspace.increment.relaxation_steps, request.tolerance,
                                            unsettled(workspace.increment)));
  }
  const auto stress = free ? std::array<double, 4>{} : piola_stress(workspace.increment);
  workspace.increment.advance_history();
  workspace.increment.export_to(given, material->initial);
  std::copy_n(stress.begin(), 4, material->initial.stress.begin());
  material->initial.dissipated = material->initial.broken_bonds = 0;
  material->initial_mean_force =
      free ? unloaded_force : std::max(workspace.increment.mean_force, least_force);
  if (material->space.finds_deformation) {
    problem.force_floor = relative_floor * material->initial_mean_force;
    load_to_stress(material->space, request, workspace, material->initial);
    material->initial_mean_force = std::max(workspace.increment.mean_force, least_force);
  }
  return material;
}

}  // namespace grainlaw
