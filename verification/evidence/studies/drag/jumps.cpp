#include "evidence/studies/drag/findings.hpp"
#include "evidence/studies/drag/host.hpp"
#include "evidence/studies/drag/sections.hpp"

#include "app/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

namespace verification::drag {
namespace {

constexpr std::array<int, 5> probed{28, 36, 44, 52, 60};  // steps of 0.1 %, drained
constexpr int every = 2;  // steps from the first of them on: P from two starts
constexpr int packings = 4;
constexpr int points = 100;
constexpr double length = 2e-3;         // of a line, as a norm of the change of F
constexpr double narrow = 1e-9;         // a change within that is a jump
constexpr double smallest_jump = 1e-4;  // of p
constexpr double many_medians = 8;
constexpr double most_at_300 = 1;
constexpr double largest_jump = 0.01;  // of p

struct Lines {
  int lines = 0, jumps = 0, failed = 0;
  double worst = 0;                // [p]
  int jumps_in_first_half = 0;     // of a line
  double worst_in_first_half = 0;  // [p]
  int ended = 0;                   // paths that reached their end, two a packing
};

// P of one increment from two starts.
struct Starts {
  int starts = 0, same = 0, told_apart = 0, apart = 0;
  double worst = 0;                                 // difference of P [p]
  double milliseconds = 0, milliseconds_again = 0;  // from the trial, and from the committed state
  std::vector<double> changes, changes_of_other;    // of status, where P is the same, and where not
};

template <int D>
std::optional<TensorOf<D>> stress_at(State& state, const TensorOf<D>& F) {
  const EvaluationOf<D> found = evaluate_of<D>(state, F, 0);
  if (found.status != GRAINLAW_OK) return std::nullopt;
  return found.stress;
}

// Narrows an interval down to where P changes most; the change left there, 0 once it is small [p].
template <int D>
double jump_within(State& state, TensorOf<D> from, TensorOf<D> to, TensorOf<D> P, TensorOf<D> Q) {
  while ((Q - P).norm() > smallest_jump * pressure) {
    if ((to - from).norm() < narrow) return (Q - P).norm() / pressure;
    const TensorOf<D> middle = 0.5 * (from + to);
    const auto there = stress_at<D>(state, middle);
    if (!there) return told;
    if ((*there - P).norm() > (Q - *there).norm()) {
      to = middle;
      Q = *there;
    } else {
      from = middle;
      P = *there;
    }
  }
  return 0;
}

// Intervals whose change is no mean of their neighbours' are looked at closely. A jump is above
// many medians of the line too: its interval is 20000 times as narrow.
template <int D>
void walk_line(Lines& lines, State& state, const TensorOf<D>& from, const TensorOf<D>& direction) {
  ++lines.lines;
  std::vector<TensorOf<D>> F, P;
  for (int k = 0; k <= points; ++k) {
    const TensorOf<D> deformation = from + length * k / points * direction;
    const auto found = stress_at<D>(state, deformation);
    if (!found) {
      ++lines.failed;
      continue;
    }
    F.push_back(deformation);
    P.push_back(*found);
  }
  std::vector<double> changes;
  for (std::size_t k = 0; k + 1 < P.size(); ++k) changes.push_back((P[k + 1] - P[k]).norm());
  const double usual = median(changes) * narrow * points / length;
  for (std::size_t k = 0; k + 1 < P.size(); ++k) {
    const TensorOf<D> change = P[k + 1] - P[k];
    TensorOf<D> neighbours = TensorOf<D>::Zero();
    int count = 0;
    if (k > 0) {
      neighbours += P[k] - P[k - 1];
      ++count;
    }
    if (k + 2 < P.size()) {
      neighbours += P[k + 2] - P[k + 1];
      ++count;
    }
    if ((change - neighbours / std::max(count, 1)).norm() < smallest_jump * pressure) continue;
    const double jump = jump_within<D>(state, F[k], F[k + 1], P[k], P[k + 1]);
    if (std::isnan(jump)) ++lines.failed;
    if (!(jump * pressure > many_medians * usual)) continue;
    ++lines.jumps;
    lines.worst = std::max(lines.worst, jump);
    if (k >= points / 2) continue;
    ++lines.jumps_in_first_half;
    lines.worst_in_first_half = std::max(lines.worst_in_first_half, jump);
  }
}

// P of the next increment after another trial, and from the committed state alone.
template <int D>
void start_twice(Starts& starts, const State& committed, const TensorOf<D>& from,
                 const TensorOf<D>& to) {
  constexpr double way = 0.7, same = 1e-8;
  State state(committed);
  state.revert();
  const TensorOf<D> between = from + way * (to - from);
  if (!stress_at<D>(state, between)) return;
  double start = cpu_seconds();
  const EvaluationOf<D> warm = evaluate_of<D>(state, to, 0);
  starts.milliseconds += 1e3 * (cpu_seconds() - start);
  state.revert();
  start = cpu_seconds();
  const EvaluationOf<D> cold = evaluate_of<D>(state, to, 0);
  starts.milliseconds_again += 1e3 * (cpu_seconds() - start);
  if (cold.status != GRAINLAW_OK || warm.status != GRAINLAW_OK) return;
  ++starts.starts;
  const double difference = (cold.stress - warm.stress).norm();
  starts.worst = std::max(starts.worst, difference / pressure);
  if (difference > smallest_jump * pressure) ++starts.apart;
  const bool is_same = difference <= same * cold.stress.norm();
  (is_same ? starts.changes : starts.changes_of_other)
      .push_back(static_cast<double>(warm.report.status_changes));
  if (is_same) {
    ++starts.same;
  } else if (warm.report.message[0] != 0) {
    ++starts.told_apart;
  }
}

template <int D>
void look_along(Lines& lines, Starts& by_state, Starts& by_trial, Study& study,
                const Packing& packing) {
  constexpr double step_size = 1e-3;
  std::mt19937 random(static_cast<unsigned>(packing.seed));
  std::normal_distribution<double> normal;
  const auto start = [](Starts& starts, const PointStepOf<D>& step) {
    if (step.record.step >= probed.front() && step.record.step % every == 0)
      start_twice<D>(starts, step.state, step.committed_deformation, step.record.deformation);
  };
  const auto follow = [&](bool from_trial, const PointObserverOf<D>& observe) {
    const Drained path = drained<D>(study.materials(packing, {.from_trial = from_trial}),
                                    step_size * probed.back(), probed.back(), {}, observe);
    lines.ended += path.failure.empty() ? 1 : 0;
  };
  follow(true, [&](const PointStepOf<D>& step) { start(by_trial, step); });
  tell(fmt::format(
      "jumps: {}: P from two starts the same in {} of {} steps, apart in {}, by {:.2e} p\n",
      packing.name(), by_trial.same, by_trial.starts, by_trial.apart, by_trial.worst));
  follow(false, [&](const PointStepOf<D>& step) {
    start(by_state, step);
    if (std::find(probed.begin(), probed.end(), step.record.step) == probed.end()) return;
    const TensorOf<D> from = step.record.deformation;
    const TensorOf<D> onward = from - step.committed_deformation;
    State state(step.state);
    state.commit();
    TensorOf<D> any;
    for (int k = 0; k < D * D; ++k) any(k) = normal(random);
    any -= any.trace() / D * TensorOf<D>::Identity();
    for (const TensorOf<D>& direction : {onward, any}) {
      walk_line<D>(lines, state, from, direction / direction.norm());
      tell(
          fmt::format("jumps: {}: {} lines, {} jumps of up to {:.2e} p, {} and {:.2e} p to 0.1 %\n",
                      packing.name(), lines.lines, lines.jumps, lines.worst,
                      lines.jumps_in_first_half, lines.worst_in_first_half));
    }
  });
}

// Starts that lead to another P, untold.
double other(const Starts& starts) { return starts.starts - starts.same - starts.told_apart; }

}  // namespace

void count_jumps(Study& study) {
  Findings findings(
      study.options(), "jumps",
      "forty lines of 100 points within 0.2 %, onward and anywhere, from five states of each "
      "packing drained to 6 %: changes of P above 1e-4 p within 1e-9 of strain; P of steps from "
      "two starts, the committed state and another trial: with solver.start = committed, which "
      "takes none, and with trial; apart: by more than 1e-4 p",
      {"packings", "stiffness", "lines[-]", "failed[-]", "ended[-]", "jumps_to_0.1%[-]",
       "worst_to_0.1%[p]", "starts[-]", "same_start[-]", "told_apart[-]", "apart[-]",
       "worst_start[p]", "changes[-]", "changes_of_other[-]", "from_trial[ms]",
       "from_committed[ms]"},
      {{"jumps[-]"}, {"worst[p]"}, {"other_by_committed[-]"}, {"other_by_trial[-]"}});
  for (const int dimension : {2, 3}) {
    for (const double stiffness : {300.0, 3e3, 3e4}) {
      if (!study.takes(dimension, stiffness)) continue;
      Lines lines;
      Starts by_state, by_trial;
      const int count = study.packings(packings);
      for (Packing packing : dimension == 2 ? discs(count, 200) : spheres(count, 150)) {
        packing.young = young_of(dimension, stiffness);
        in_dimension(dimension,
                     [&](auto d) { look_along<d>(lines, by_state, by_trial, study, packing); });
      }
      const double tried = std::max(1, by_trial.starts);
      findings.row({fmt::format("{} of {}", count, dimension == 2 ? "200 discs" : "150 spheres"),
                    fmt::format("{:g}", stiffness), static_cast<double>(lines.lines),
                    static_cast<double>(lines.failed), static_cast<double>(lines.ended),
                    static_cast<double>(lines.jumps_in_first_half), lines.worst_in_first_half,
                    static_cast<double>(by_trial.starts), static_cast<double>(by_trial.same),
                    static_cast<double>(by_trial.told_apart), static_cast<double>(by_trial.apart),
                    by_trial.worst, average(by_trial.changes), average(by_trial.changes_of_other),
                    by_trial.milliseconds / tried, by_trial.milliseconds_again / tried},
                   {{static_cast<double>(lines.jumps), stiffness < 1e3 ? most_at_300 : told},
                    {lines.worst, largest_jump},
                    {other(by_state), 0},
                    {other(by_trial), 0}});
    }
  }
  findings.print();
}

}  // namespace verification::drag
