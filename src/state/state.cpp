#include "state/state.hpp"

#include "contact/frictional.hpp"
#include "equilibrium/chain.hpp"
#include "homogenise/stress.hpp"
#include "state/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <tuple>
#include <utility>

namespace grainlaw {

namespace {

// A larger stretch in one increment would leave no contact of the committed packing where it was.
constexpr double largest_stretch_change = 0.3;
// Step of the forward differences of the perturbed tangent: well above the tolerance it is solved to,
// well below the increments of a host.
constexpr double perturbation = 1e-5;
constexpr double perturbed_tolerance = 1e-9;

Workspace& workspace() {
  thread_local Workspace instance;
  return instance;
}

void describe(grainlaw_report& report, const char* text) {
  std::snprintf(report.message, sizeof report.message, "%s", text);
}

// Contacts that opened, closed, began or ceased to slide between two configurations.
int status_changes(const Configuration& before, const Configuration& after) {
  const auto key = [](const ContactHistory& c) { return std::tie(c.i, c.j, c.shift); };
  auto a = before.contacts.begin();
  int changes = 0;
  for (const auto& contact : after.contacts) {
    for (; a != before.contacts.end() && key(*a) < key(contact); ++a) ++changes;
    const bool known = a != before.contacts.end() && key(*a) == key(contact);
    if (!known || a->sliding != contact.sliding) ++changes;
    if (known) ++a;
  }
  return changes + static_cast<int>(before.contacts.end() - a);
}

void count_contacts(const Increment& increment, const ContactLaw& law, grainlaw_report& report) {
  const auto& list = increment.contacts;
  for (std::size_t c = 0; c < list.size(); ++c) {
    const auto point = contact_point(list, c, increment.coordinates, increment.particles(),
                                     increment.cell, law);
    report.contacts += point.status != ContactStatus::open ? 1 : 0;
    report.sliding += point.status == ContactStatus::sliding ? 1 : 0;
  }
}

void rotate_configuration(const Increment2& increment, const double* F, std::size_t particles,
                          Configuration& configuration) {
  const auto& r = increment.rotation;
  auto& z = configuration.coordinates;
  for (std::size_t p = 0; p < particles; ++p) {
    const double x = z[p];
    const double y = z[particles + p];
    z[p] = r[0] * x + r[1] * y;
    z[particles + p] = r[2] * x + r[3] * y;
  }
  for (std::size_t k = 2 * particles; k < z.size(); ++k) z[k] += increment.angle;
  std::copy_n(F, 4, configuration.deformation.begin());
}

}  // namespace

State::State(std::shared_ptr<const Material> material)
    : material_(std::move(material)), committed_(material_->initial) {}

bool State::commit() {
  if (!has_trial_) return false;
  std::swap(committed_, trial_);
  has_trial_ = false;
  return true;
}

void State::restore(Configuration committed) {
  committed_ = std::move(committed);
  has_trial_ = false;
}

grainlaw_status State::evaluate(const double* F, TangentKind kind, double* P, double* A,
                                grainlaw_report& report) {
  const Material& material = *material_;
  const double* committed = committed_.deformation.data();
  const auto split = split_rotation(F, committed);
  for (std::size_t k = 0; k < 4; ++k) {
    const double identity = k == 0 || k == 3 ? 1 : 0;
    if (!(std::abs(split.stretch[k] - identity) <= largest_stretch_change)) {
      has_trial_ = false;
      report.step_ratio = 0.1;
      describe(report, "the stretch since the committed state is more than 30 %");
      return GRAINLAW_STEP_TOO_LARGE;
    }
  }

  Workspace& w = workspace();
  const Problem problem{&material.packing, &material.law, &material.space,
                        1e-3 * material.initial_mean_force};
  Request request{&problem, &material.solver, &committed_, split.target};
  request.tolerance = material.solver.tolerance;
  request.sensitivities = kind == TangentKind::exact;
  std::vector<double> guess;
  if (material.solver.start == Start::trial && has_trial_) {
    const auto last = split_rotation(trial_.deformation.data(), committed);
    const auto n = material.packing.size();
    guess = trial_.coordinates;
    for (std::size_t p = 0; p < n; ++p) {
      const double x = guess[p];
      const double y = guess[n + p];
      guess[p] = last.rotation[0] * x + last.rotation[2] * y;
      guess[n + p] = last.rotation[1] * x + last.rotation[3] * y;
    }
    for (std::size_t k = 2 * n; k < guess.size(); ++k) {
      guess[k] -= committed_.coordinates[k] + last.angle;
    }
    request.guess = &guess;
    request.guess_deformation = last.target;
  }
  has_trial_ = false;

  const auto add_cost = [&] {
    report.relaxation_steps += w.increment.relaxation_steps;
    report.servo_corrections += w.increment.servo_corrections;
    report.factorisations += w.increment.factorisations;
  };
  const auto outcome = solve(request, w);
  add_cost();
  report.step_ratio = outcome.step_ratio;
  report.subincrements = outcome.subincrements;
  report.history_advanced = outcome.history_advanced ? 1 : 0;
  report.residual = w.increment.residual_norm();
  if (outcome.status != GRAINLAW_OK) {
    describe(report, grainlaw_status_text(outcome.status));
    return outcome.status;
  }
  count_contacts(w.increment, material.law, report);

  const auto stress = piola_stress(w.increment);
  std::array<double, 16> tangent{};
  if (kind == TangentKind::exact) {
    if (outcome.sensitivities) {
      tangent = condensed_tangent(w.increment, w.sensitivity);
      report.tangent_exact = outcome.history_advanced ? 0 : 1;
    } else {
      tangent = elastic_tangent(w.increment);
      describe(report, "the stiffness is singular; the elastic tangent was returned");
    }
  } else if (kind == TangentKind::elastic) {
    tangent = elastic_tangent(w.increment);
  }

  w.increment.advance_history();
  w.increment.export_to(committed_, trial_);
  std::copy_n(stress.begin(), 4, trial_.stress.begin());
  report.status_changes = status_changes(committed_, trial_);

  if (kind == TangentKind::perturbed) {
    request.tolerance = std::min(request.tolerance, perturbed_tolerance);
    request.guess = nullptr;
    for (std::size_t k = 0; k <= 4; ++k) {
      // The last one is the centre, at the tolerance of the others.
      request.deformation = split.target;
      if (k < 4) request.deformation[k] += perturbation;
      const auto perturbed = solve(request, w);
      add_cost();
      if (perturbed.status != GRAINLAW_OK) {
        describe(report, "a perturbed increment found no equilibrium");
        return perturbed.status;
      }
      const auto p = piola_stress(w.increment);
      for (std::size_t m = 0; m < 4; ++m) {
        for (std::size_t l = 0; l < 4; ++l) {
          if (k == 4) tangent[m * 4 + l] -= p[m] / perturbation;
          if (k == l) tangent[m * 4 + k] += p[m] / perturbation;
        }
      }
    }
  }

  const auto rotated = rotate_stress(split, stress);
  rotate_configuration(split, F, material.packing.size(), trial_);
  std::copy_n(rotated.begin(), 4, trial_.stress.begin());
  if (P != nullptr) std::copy_n(rotated.begin(), 4, P);
  if (A != nullptr && kind != TangentKind::none) {
    const auto a = rotate_tangent(split, committed, stress, tangent);
    std::copy_n(a.begin(), 16, A);
  }
  has_trial_ = true;
  return GRAINLAW_OK;
}

}  // namespace grainlaw
