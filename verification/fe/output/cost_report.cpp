#include "fe/output/cost_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace verification {

void CostReport::add(const LoadStep& step, const Solver& solver) {
  const Cost& cost = solver.points().cost();
  if (!started_) {
    started_ = true;
    start_ = Spent::now();
    for (std::size_t k = 0; k < stages; ++k) at_start_[k] = cost.of(static_cast<Stage>(k));
    return;
  }
  ++steps_;
  evaluations_ += step.record.effort.evaluations;
  total_ = Spent::now() - start_;
}

std::string CostReport::summary(const Solver& solver) const {
  const Cost& cost = solver.points().cost();
  const auto points = static_cast<double>(solver.points().size());
  const double steps = std::max(steps_, 1);
  std::string text = fmt::format(
      "{} points: {:.2f} evaluations and {:.3f} core-milliseconds per point and load step; "
      "{:.2f} core-seconds, {:.2f} s elapsed\n",
      points, evaluations_ / steps, 1e3 * total_.cpu / (steps * points), total_.cpu,
      total_.elapsed);
  double rest = total_.cpu;
  std::vector<std::string> parts;
  const auto part = [&](const char* name, double cpu) {
    parts.push_back(fmt::format("{} {:.1f} %", name, 100 * cpu / std::max(total_.cpu, 1e-9)));
  };
  constexpr std::array<const char*, stages> names{"points", "assembly", "linear solve", "output"};
  for (std::size_t k = 0; k < stages; ++k) {
    const Spent spent = cost.of(static_cast<Stage>(k)) - at_start_[k];
    part(names[k], spent.cpu);
    rest -= spent.cpu;
  }
  part("rest", rest);
  return text + fmt::format("core-seconds went to {}\n", fmt::join(parts, ", "));
}

}  // namespace verification
