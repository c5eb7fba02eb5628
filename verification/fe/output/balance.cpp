#include "fe/output/balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace verification {

std::vector<std::string> balance_columns() {
  return {"step[-]", "residual[-]",      "iterations[-]",  "last_iterations[-]",
          "cuts[-]", "jumps_crossed[-]", "loose_parts[-]", "history_advanced[-]"};
}

std::vector<double> balance_values(const LoadStep& step) {
  const Effort& effort = step.record.effort;
  const auto last = step.attempts.empty() ? 0 : step.residuals.size() - step.attempts.back() - 1;
  return {static_cast<double>(step.record.step),  step.balance,
          static_cast<double>(effort.iterations), static_cast<double>(last),
          static_cast<double>(effort.cuts),       static_cast<double>(effort.crossed),
          static_cast<double>(effort.loose),      static_cast<double>(effort.history_advanced)};
}

std::string balance_summary(const CsvTable& table) {
  if (table.rows() == 0) return {};
  // Step 0 is the start, not a load step.
  const auto first = table["step"].front() == 0 ? 1 : 0;
  std::vector<double> iterations(table["iterations"].begin() + first, table["iterations"].end());
  if (iterations.empty()) return {};
  std::sort(iterations.begin(), iterations.end());
  const auto percentile = [&](double share) {
    const auto rank = std::ceil(share * static_cast<double>(iterations.size()));
    return iterations[static_cast<std::size_t>(rank) - 1];
  };
  const std::vector<double>&residuals = table["residual"], &loose = table["loose_parts"];
  const auto unbalanced =
      std::count_if(loose.begin() + first, loose.end(), [](double parts) { return parts > 0; });
  return fmt::format(
      "{} of {} load steps balanced, to {:.1e} at worst; iterations of a step {:.0f} in the "
      "median, "
      "{:.0f} at most in 95 %, {:.0f} at most\n",
      iterations.size() - static_cast<std::size_t>(unbalanced), iterations.size(),
      *std::max_element(residuals.begin() + first, residuals.end()), percentile(0.5),
      percentile(0.95), iterations.back());
}

}  // namespace verification
