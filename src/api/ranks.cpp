#include "api/ranks.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace grainlaw::core::api {

namespace {

// Fatal before recoverable before none, then the lowest rank: as one number to take the least of.
constexpr double of_class = 4294967296.0;
constexpr double no_failure = 2 * of_class;

double precedence(const Ranks& ranks, grainlaw_status status) {
  if (status == GRAINLAW_OK) return no_failure;
  return (status < 0 ? 0 : of_class) + ranks.rank;
}

}  // namespace

int agree(const Ranks& ranks, Summary& summary) {
  if (ranks.reduce == nullptr) return -1;
  std::array<double, 2> least{precedence(ranks, summary.status), summary.step_ratio};
  const double mine = least[0];
  ranks.reduce(ranks.context, least.data(), static_cast<int>(least.size()), GRAINLAW_MIN);
  if (least[0] == no_failure) return -1;
  // The first failed rank tells all others; they add zeros.
  constexpr std::size_t failed = 0, status = 1, first = 2, text = 3;
  std::array<double, text + sizeof summary.message> told{};
  told[failed] = static_cast<double>(summary.failed);
  if (mine == least[0]) {
    told[status] = summary.status;
    told[first] = static_cast<double>(summary.first_failed);
    std::copy_n(summary.message, sizeof summary.message, &told[text]);
  }
  ranks.reduce(ranks.context, told.data(), static_cast<int>(told.size()), GRAINLAW_SUM);
  summary.status = static_cast<grainlaw_status>(told[status]);
  summary.failed = static_cast<std::size_t>(told[failed]);
  summary.first_failed = static_cast<std::size_t>(told[first]);
  summary.step_ratio = least[1];
  std::transform(&told[text], told.data() + told.size(), summary.message,
                 [](double letter) { return static_cast<char>(letter); });
  return static_cast<int>(least[0] >= of_class ? least[0] - of_class : least[0]);
}

bool agree(const Ranks& ranks, bool mine) {
  if (ranks.reduce == nullptr) return mine;
  double all = mine ? 1 : 0;
  ranks.reduce(ranks.context, &all, 1, GRAINLAW_MIN);
  return all == 1;
}

}  // namespace grainlaw::core::api
