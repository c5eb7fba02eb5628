#include "evidence/studies/drag/findings.hpp"
#include "evidence/studies/drag/host.hpp"
#include "evidence/studies/drag/sections.hpp"

#include <fmt/format.h>

#include <array>

namespace verification::drag {
namespace {

constexpr std::array increments{1e-3, 1e-4, 1e-5};
constexpr int states = 20;

struct Cost {
  std::vector<double> milliseconds, steps, factorisations;
  double failed = 0;
};

// Along isochoric compression in steps of 0.1 %: from each state an increment of each size, of the
// law and of equilibrium in turn.
template <int D>
std::array<std::array<Cost, increments.size()>, 2> costs(Study& study, const Packing& packing) {
  std::array<std::array<Cost, increments.size()>, 2> result;
  std::array<Host<D>, 2> hosts{Host<D>(study.materials(packing, equilibrium)),
                               Host<D>(study.materials(packing, {}))};
  for (int k = 1; k <= states; ++k) {
    for (Host<D>& host : hosts) host.lead(isochoric<D>(1e-3 * k));
    for (std::size_t i = 0; i < increments.size(); ++i) {
      for (std::size_t law = 0; law < hosts.size(); ++law) {
        State state(hosts[law].state);
        Cost& cost = result[law][i];
        const TensorOf<D> F = isochoric<D>(1e-3 * k + increments[i]);
        const double start = cpu_seconds();
        const EvaluationOf<D> found = evaluate_of<D>(state, F, GRAINLAW_WANT_TANGENT_EXACT);
        cost.milliseconds.push_back(1e3 * (cpu_seconds() - start));
        cost.steps.push_back(static_cast<double>(found.report.relaxation_steps));
        cost.factorisations.push_back(found.report.factorisations);
        cost.failed += found.status == GRAINLAW_OK ? 0 : 1;
      }
    }
  }
  return result;
}

}  // namespace

void measure_cost(Study& study) {
  Findings findings(study.options(), "cost",
                    "one evaluation with the exact tangent, medians of 20 states along isochoric "
                    "compression; the law and equilibrium in turn; its time over that of the "
                    "increment ten times as large",
                    {"packing", "increment", "ms[-]", "equilibrium_ms[-]", "over_equilibrium[-]",
                     "relaxation_steps[-]", "equilibrium_steps[-]", "factorisations[-]",
                     "equilibrium_factorisations[-]"},
                    {{"over_larger[-]"}, {"failed[-]"}});
  std::vector<Packing> packings{discs(1).front(),
                                {.file = "rve400"},
                                spheres(1).front(),
                                {.dimension = 3, .young = 1e8, .file = "spheres500"}};
  for (const Packing& packing : packings) {
    in_dimension(packing.dimension, [&](auto d) {
      const auto cost = costs<d>(study, packing);
      double larger = told;
      for (std::size_t i = 0; i < increments.size(); ++i) {
        const Cost& rest = cost[0][i];
        const Cost& law = cost[1][i];
        const double own = median(law.milliseconds);
        const double other = median(rest.milliseconds);
        findings.row({packing.name(), fmt::format("{:g}", increments[i]), own, other, own / other,
                      median(law.steps), median(rest.steps), median(law.factorisations),
                      median(rest.factorisations)},
                     {{own / larger, i == 0 ? told : 1}, {law.failed, 0}});
        larger = own;
      }
    });
  }
  findings.print();
}

}  // namespace verification::drag
