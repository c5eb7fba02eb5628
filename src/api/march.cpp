// Marches: what a host tells, agreed by the ranks of its set.
#include "points/march.hpp"

#include "api/guard.hpp"
#include "api/handle.hpp"
#include "api/report.hpp"

#include <grainlaw/grainlaw.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>

using namespace grainlaw::core;

namespace {

// The one version of these structs.
template <class Struct>
bool known_size(const Struct* of_caller) {
  return api::claimed_size(of_caller) == sizeof(Struct);
}

grainlaw_status check_march(const grainlaw_march* handle) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  return handle->set == nullptr ? GRAINLAW_OK : api::check_handle(handle->set);
}

api::Ranks ranks_of(const grainlaw_march& march) {
  return march.set == nullptr ? api::Ranks{} : march.set->ranks;
}

Summary summary_of(grainlaw_status status, const grainlaw_summary* told) {
  Summary summary;
  summary.status = status;
  if (status == GRAINLAW_OK) return summary;
  summary.step_ratio = told == nullptr ? stepping::largest_cut : told->step_ratio;
  const bool explained = told != nullptr && told->message[0] != '\0';
  const char* const reason = explained ? told->message : grainlaw_status_text(status);
  std::array<char, 64> whose{};
  if (told != nullptr && told->failed > 0) {
    const int rank = told->size < sizeof *told ? -1 : told->rank;
    if (rank >= 0) std::snprintf(whose.data(), 32, "rank %d, ", rank);
    std::snprintf(whose.data() + std::strlen(whose.data()), 32, "point %ld: ", told->first_failed);
  }
  std::snprintf(summary.message, sizeof summary.message, "%s%s", whose.data(), reason);
  return summary;
}

// Norms of one rank, or of all.
struct Norms {
  double residual, scale;
  double unforeseen;  // negative: unknown
};

Norms add_ranks(const api::Ranks& ranks, const Norms& mine) {
  if (ranks.reduce == nullptr) return mine;
  const bool unknown = !(mine.unforeseen >= 0);
  std::array<double, 4> sums{mine.residual * mine.residual, mine.scale * mine.scale,
                             unknown ? 0 : mine.unforeseen * mine.unforeseen, unknown ? 1.0 : 0.0};
  ranks.reduce(ranks.context, sums.data(), static_cast<int>(sums.size()), GRAINLAW_SUM);
  return {std::sqrt(sums[0]), std::sqrt(sums[1]), sums[3] > 0 ? -1 : std::sqrt(sums[2])};
}

double unforeseen_by(const grainlaw_points* set) {
  if (set == nullptr) return -1;
  const double squares = unforeseen(set->points);
  return squares < 0 ? -1 : std::sqrt(squares);
}

}  // namespace

grainlaw_march_options grainlaw_march_options_default(void) { return default_march_options(); }

grainlaw_part grainlaw_part_default(void) {
  grainlaw_part part{};
  part.size = sizeof part;
  return part;
}

grainlaw_status grainlaw_march_create(const grainlaw_march_options* options, grainlaw_points* set,
                                      grainlaw_march** out) {
  if (out == nullptr) return GRAINLAW_NULL_POINTER;
  *out = nullptr;
  if (set != nullptr && api::check_handle(set) != GRAINLAW_OK) return GRAINLAW_BAD_HANDLE;
  if (options != nullptr && !known_size(options)) return GRAINLAW_BAD_REPORT;
  const auto how = options == nullptr ? grainlaw_march_options_default() : *options;
  if (!valid(how)) return GRAINLAW_BAD_ARGUMENT;
  return api::guarded([&] { *out = new grainlaw_march(how, set); });
}

void grainlaw_march_destroy(grainlaw_march* handle) {
  if (api::check_handle(handle) == GRAINLAW_OK) delete handle;
}

grainlaw_status grainlaw_march_begin(grainlaw_march* handle, double from, double to) {
  const api::FloatingEnvironment environment;
  if (const auto status = check_march(handle); status != GRAINLAW_OK) return status;
  if (!std::isfinite(to - from)) return GRAINLAW_BAD_ARGUMENT;
  handle->march.begin(from, to);
  return GRAINLAW_OK;
}

grainlaw_action grainlaw_march_next(grainlaw_march* handle, grainlaw_part* part) {
  const api::FloatingEnvironment environment;
  if (check_march(handle) != GRAINLAW_OK) return GRAINLAW_GIVE_UP;
  if (part != nullptr && !known_size(part)) return GRAINLAW_GIVE_UP;
  March& march = handle->march;
  const grainlaw_action action = march.next();
  if (part != nullptr) api::copy_out(march.part(), part);
  if (handle->set != nullptr && march.begins_attempt())
    grainlaw_points_set_time_step(handle->set, march.options().step_time * march.part().time);
  return action;
}

double grainlaw_march_share(grainlaw_march* handle, double largest_change) {
  const api::FloatingEnvironment environment;
  if (check_march(handle) != GRAINLAW_OK || !handle->march.asks()) return 0;
  double share = handle->march.bound(largest_change);
  const api::Ranks ranks = ranks_of(*handle);
  if (ranks.reduce != nullptr) ranks.reduce(ranks.context, &share, 1, GRAINLAW_MIN);
  handle->march.apply(share);
  return share;
}

grainlaw_status grainlaw_march_tell(grainlaw_march* handle, grainlaw_status status,
                                    const grainlaw_summary* summary, double residual, double scale,
                                    double unforeseen) {
  const api::FloatingEnvironment environment;
  if (const auto found = check_march(handle); found != GRAINLAW_OK) return found;
  if (summary != nullptr && !api::known_summary_size(api::claimed_size(summary)))
    return GRAINLAW_BAD_REPORT;
  if (!handle->march.asks()) return GRAINLAW_BAD_ARGUMENT;
  Summary agreed = summary_of(status, summary);
  api::agree(ranks_of(*handle), agreed);
  Told told;
  told.found = agreed.status == GRAINLAW_OK;
  told.step_ratio = agreed.step_ratio;
  told.reason = agreed.message;
  if (told.found) {
    if (unforeseen < 0) unforeseen = unforeseen_by(handle->set);
    const Norms all = add_ranks(ranks_of(*handle), {residual, scale, unforeseen});
    told.residual = all.residual / all.scale;
    told.unforeseen = all.unforeseen;
  }
  handle->march.tell(told);
  return GRAINLAW_OK;
}

double grainlaw_march_cut(double step_ratio) {
  const api::FloatingEnvironment environment;
  return cut_ratio(step_ratio);
}
