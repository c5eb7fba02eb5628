#include "evidence/studies/drag/findings.hpp"
#include "evidence/studies/drag/host.hpp"
#include "evidence/studies/drag/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace verification::drag {
namespace {

constexpr double before = 0.01;  // strain in steps of 0.1 % before anything is asked for
constexpr double usual = 1e-3;
constexpr double largest_rest = 1e-6;  // unbalanced after a hold, and P turned against P
constexpr double hold = 100;           // memories

// Trials from one committed state.
struct Trials {
  double tried = 0, failed = 0, relaxation_steps = 0, change = 0;  // steps: the most; |dP| / |P|
};

template <int D>
void attempt(Trials& trials, const Host<D>& from, const TensorOf<D>& to, double time) {
  State state(from.state);
  check(grainlaw_state_set_time_step(state.get(), time), "telling the time step");
  const EvaluationOf<D> found = evaluate_of<D>(state, to, GRAINLAW_WANT_TANGENT_EXACT);
  ++trials.tried;
  trials.relaxation_steps =
      std::max(trials.relaxation_steps, static_cast<double>(found.report.relaxation_steps));
  if (found.status != GRAINLAW_OK || !found.stress.allFinite() || !found.tangent.allFinite())
    ++trials.failed;
  else
    trials.change = (found.stress - from.stress).norm() / from.stress.norm();
}

template <int D>
Host<D> lead_before(const Material& material, double time) {
  Host<D> host(material);
  for (int k = 1; usual * k < before + 1e-9; ++k) host.lead(isochoric<D>(usual * k), time);
  return host;
}

void add(Findings& findings, const Packing& packing, const std::string& name,
         const Trials& trials) {
  findings.row({packing.name(), name, trials.tried, trials.relaxation_steps, trials.change},
               {{trials.failed, 0}, {told}});
}

template <int D>
void of_strain(Study& study, Findings& findings, const Packing& packing) {
  const Host<D> host = lead_before<D>(study.materials(packing, {}), 1);
  for (const double direction : {1.0, -1.0}) {
    for (const double size : {1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 2e-3, 5e-3}) {
      Trials trials;
      attempt<D>(trials, host, isochoric<D>(before + direction * size), 1);
      add(findings, packing, fmt::format("strain {:g}", direction * size), trials);
    }
  }
  Trials trials;
  attempt<D>(trials, host, host.deformation, 1);
  add(findings, packing, "no strain", trials);
}

template <int D>
void of_time(Study& study, Findings& findings, const Packing& packing) {
  const Setting in_host_time{.rate = 1};
  const double memory = study.materials.number() / in_host_time.rate;
  const Material material = study.materials(packing, in_host_time);
  const Host<D> host = lead_before<D>(material, usual);
  for (const double strain : {0.0, 1e-3}) {
    for (const double time : {1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12}) {
      Trials trials;
      attempt<D>(trials, host, isochoric<D>(before + strain), time);
      add(findings, packing, fmt::format("strain {:g} in a time of {:g}", strain, time), trials);
    }
  }
  for (const int parts : {1, 10, 100}) {
    Host<D> resting(host);
    double failed = 0;
    for (int k = 0; k < parts; ++k)
      failed += resting.lead(resting.deformation, hold * memory / parts, 0) ? 0 : 1;
    findings.row({packing.name(), fmt::format("hold of 100 memories in {} parts", parts),
                  static_cast<double>(parts), resting.relaxation_steps / resting.evaluations,
                  (resting.stress - host.stress).norm() / host.stress.norm()},
                 {{failed, 0}, {resting.report.unbalanced, largest_rest}});
  }
}

// The rotation by an angle about an axis oblique to all.
template <int D>
TensorOf<D> rotated(double angle) {
  if constexpr (D == 2)
    return Eigen::Rotation2Dd(angle).toRotationMatrix();
  else
    return Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
}

// Ten turns while it is compressed, against no turn; and ten turns in place.
template <int D>
void of_turns(Study& study, Findings& findings, const Packing& packing) {
  constexpr int turns = 10, steps = 120;
  constexpr double strain = 0.015;
  const Material material = study.materials(packing, {.tolerance = 1e-10});
  Host<D> plain(material), rotating(material);
  double failed = 0, worst = 0;
  const auto rotation = [&](int k) { return rotated<D>(2 * std::numbers::pi * turns * k / steps); };
  for (int k = 1; k <= steps; ++k) {
    const TensorOf<D> F = isochoric<D>(strain * k / steps);
    failed += plain.lead(F) ? 0 : 1;
    failed += rotating.lead(rotation(k) * F) ? 0 : 1;
    worst = std::max(worst, (rotating.stress - rotation(k) * plain.stress).norm());
  }
  findings.row({packing.name(), "ten turns while compressed", 2.0 * steps,
                rotating.relaxation_steps / rotating.evaluations, worst / plain.stress.norm()},
               {{failed, 0}, {worst / plain.stress.norm(), largest_rest}});
  failed = 0;
  for (int k = 1; k <= steps; ++k) failed += rotating.lead(rotation(k) * plain.deformation) ? 0 : 1;
  const double change = (rotating.stress - plain.stress).norm() / plain.stress.norm();
  findings.row({packing.name(), "ten turns in place", 1.0 * steps,
                rotating.relaxation_steps / rotating.evaluations, change},
               {{failed, 0}, {told}});
}

}  // namespace

void measure_short(Study& study) {
  Findings findings(study.options(), "short",
                    "steps of any size with the exact tangent, after 1 % in steps of 0.1 %; in the "
                    "host's time with viscous_rate = 1; change of P; rest: unbalanced after a "
                    "hold, and P turned back against P of no turn",
                    {"packing", "step", "tried[-]", "relaxation_steps[-]", "change[-]"},
                    {{"failed[-]"}, {"rest[-]"}});
  for (const Packing& packing : {discs(1).front(), spheres(1).front()}) {
    in_dimension(packing.dimension, [&](auto d) {
      of_strain<d>(study, findings, packing);
      of_time<d>(study, findings, packing);
      of_turns<d>(study, findings, packing);
    });
  }
  findings.print();
}

}  // namespace verification::drag
