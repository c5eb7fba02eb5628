#include "evidence/studies/drag/findings.hpp"
#include "evidence/studies/drag/host.hpp"
#include "evidence/studies/drag/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

namespace verification::drag {
namespace {

constexpr int wanted = 40;
constexpr double largest_error = 1e-6;
constexpr double largest_strain = 0.02;  // of the states
constexpr double usual = 1e-3;

struct Errors {
  std::vector<double> smooth;
  std::vector<double> kinked;  // a contact changes between the two sides of the smallest step
};

struct Comparison {
  double error = std::numeric_limits<double>::infinity();  // relative, of central differences
  // Differences to both sides tell each other apart by more than that: P has a kink between.
  bool kinked = false;
};

// Nothing where a point fails.
template <int D>
std::optional<Comparison> compare(State& state, const TensorOf<D>& F, const EvaluationOf<D>& centre,
                                  double step) {
  TangentOf<D> above, below;
  for (int k = 0; k < D * D; ++k) {
    for (const double sign : {1.0, -1.0}) {
      TensorOf<D> moved = F;
      moved(k / D, k % D) += sign * step;
      const EvaluationOf<D> there = evaluate_of<D>(state, moved, 0);
      if (there.status != GRAINLAW_OK) return std::nullopt;
      const TensorOf<D> change = sign / step * (there.stress - centre.stress);
      (sign > 0 ? above : below).col(k) = components_of<D>(change);
    }
  }
  const TangentOf<D> central = 0.5 * (above + below);
  const double error = (centre.tangent - central).norm();
  return Comparison{error / central.norm(), (above - below).norm() > error};
}

template <int D>
void check_one(Errors& errors, State state, const TensorOf<D>& F, double time) {
  check(grainlaw_state_set_time_step(state.get(), time), "telling the time step");
  const EvaluationOf<D> centre = evaluate_of<D>(state, F, GRAINLAW_WANT_TANGENT_EXACT);
  if (centre.status != GRAINLAW_OK || centre.report.tangent_exact == 0) return;
  Comparison best;
  for (const double step : {1e-6, 1e-7, 1e-8}) {
    const auto found = compare<D>(state, F, centre, step);
    if (found && found->error < best.error) best = *found;
  }
  const bool at_kink = best.error > largest_error && best.kinked;
  (at_kink ? errors.kinked : errors.smooth).push_back(best.error);
}

enum class Kind { onward, reversal };

// Random increments from states along isochoric compression, or back from them.
template <int D>
Errors check_path(const Material& material, Kind kind, bool in_host_time, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  Host<D> host(material);
  Errors errors;
  const int between = static_cast<int>(largest_strain / usual) / 20;
  for (int tried = 0, k = 1; tried < wanted; ++k) {
    if (!host.lead(isochoric<D>(usual * k), usual)) break;
    if (k % between != 0) continue;
    for (int twice = 0; twice < 2; ++twice, ++tried) {
      const double size = std::pow(10, -5 + 2.3 * uniform(random));
      TensorOf<D> change;
      if (kind == Kind::reversal) {
        change = isochoric<D>(-size) - TensorOf<D>::Identity();
      } else {
        for (int i = 0; i < D * D; ++i) change(i) = normal(random);
        change *= size / change.norm();
      }
      const TensorOf<D> F = (TensorOf<D>::Identity() + change) * host.deformation;
      const double time = in_host_time ? usual * std::pow(10, 2 * uniform(random) - 1.5) : size;
      check_one<D>(errors, host.state, F, time);
    }
  }
  return errors;
}

}  // namespace

void check_tangents(Study& study) {
  struct Case {
    const char* name;
    Kind kind;
    Setting setting;
  };
  const std::vector<Case> cases{
      {"random", Kind::onward, {.tolerance = 1e-11}},
      {"reversals", Kind::reversal, {.tolerance = 1e-11}},
      {"random, three parts", Kind::onward, {.parts = 3, .tolerance = 1e-11}},
      {"reversals, three parts", Kind::reversal, {.parts = 3, .tolerance = 1e-11}},
      {"random, host's time", Kind::onward, {.rate = 1, .tolerance = 1e-11}},
      {"reversals, host's time", Kind::reversal, {.rate = 1, .tolerance = 1e-11}},
      {"random, host's time, three parts",
       Kind::onward,
       {.rate = 1, .parts = 3, .tolerance = 1e-11}}};
  Findings findings(study.options(), "tangents",
                    "exact tangents against central differences, the best of three steps, after "
                    "increments of 1e-5 to 2e-3; apart, where P has a kink within the step",
                    {"packing", "case", "compared[-]", "median[-]", "above[-]", "at_kinks[-]",
                     "largest_at_kinks[-]"},
                    {{"largest[-]"}, {"not_compared[-]"}});
  for (const Packing& packing : {discs(1, 200).front(), spheres(1, 150).front()}) {
    in_dimension(packing.dimension, [&](auto d) {
      unsigned seed = 0;
      for (const Case& at : cases) {
        const Errors errors = check_path<d>(study.materials(packing, at.setting), at.kind,
                                            at.setting.rate > 0, ++seed);
        const auto above = std::ranges::count_if(
            errors.smooth, [](double error) { return error > largest_error; });
        const auto compared = errors.smooth.size() + errors.kinked.size();
        findings.row(
            {packing.name(), at.name, static_cast<double>(compared), median(errors.smooth),
             static_cast<double>(above), static_cast<double>(errors.kinked.size()),
             largest(errors.kinked)},
            {{largest(errors.smooth), largest_error}, {wanted - static_cast<double>(compared), 0}});
      }
    });
  }
  findings.print();
}

}  // namespace verification::drag
