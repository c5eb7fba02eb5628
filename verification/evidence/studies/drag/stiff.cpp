#include "evidence/studies/drag/findings.hpp"
#include "evidence/studies/drag/host.hpp"
#include "evidence/studies/drag/sections.hpp"

#include <fmt/format.h>

#include <cmath>

namespace verification::drag {
namespace {

constexpr double most_iterations = 5;  // in the mean of the steps
constexpr double most_cuts = 2;        // of 60 steps

struct Case {
  Packing packing;
  double step;
  int steps;
  bool cutting = true;
};

template <int D>
void lead(Study& study, Findings& findings, const Case& at) {
  constexpr double early = 0.01;
  constexpr int finer = 4;
  PointOptions options;
  if (!at.cutting) {
    options.max_cuts = 0;
    options.max_iterations = 30;
  }
  const Drained path = drained<D>(study.materials(at.packing, {.from_trial = at.cutting}),
                                  at.step * at.steps, at.steps, options);
  const Drained fine =
      drained<D>(study.materials(at.packing, {.share = 1.0 / finer, .from_trial = at.cutting}),
                 early, static_cast<int>(std::lround(early / at.step * finer)), {});
  const auto mean = [&](const Drained& of) { return of.mean_between(early / 2, early); };
  findings.row({at.packing.name(), fmt::format("{:g}", stiffness_ratio(at.packing)),
                fmt::format("{:g}", 100 * at.step), at.cutting ? "cuts" : "does not cut",
                100 * (mean(path) / mean(fine) - 1), largest(path.stress) / pressure,
                100 * average(path.unbalanced), static_cast<double>(path.effort.crossed),
                static_cast<double>(path.steps)},
               {{static_cast<double>(path.effort.iterations) / path.steps,
                 at.cutting ? most_iterations : told},
                {static_cast<double>(path.effort.cuts), at.cutting ? most_cuts : 0},
                {static_cast<double>(at.steps - path.steps), 0}});
}

}  // namespace

void lead_stiff(Study& study) {
  Findings findings(
      study.options(), "stiff",
      "drained, a host that iterates to 1e-8 and starts from its last trial; one that does not "
      "cut, whose state starts from the committed one; bias: of stress over 0.5 to 1 %, against a "
      "quarter of the number in quarters of the step",
      {"packing", "stiffness", "step[%]", "host", "bias[%]", "peak[p]", "unbalanced[%]",
       "crossed[-]", "steps[-]"},
      {{"iterations[-]"}, {"cuts[-]"}, {"steps_missing[-]"}});
  for (const double stiffness : {300.0, 3e3, 3e4}) {
    for (Packing packing : discs(study.packings(3), 300)) {
      packing.young = young_of(2, stiffness);
      lead<2>(study, findings, {packing, 1e-3, 60});
    }
  }
  for (const Packing& packing : spheres(study.packings(3)))
    lead<3>(study, findings, {packing, 1.5e-3, 40, false});
  findings.print();
}

}  // namespace verification::drag
