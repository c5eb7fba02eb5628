// Initial stress of points.
#include "points/consolidate.hpp"
#include "points/consolidate_points.hpp"

#include "api/guard.hpp"
#include "api/handle.hpp"
#include "api/some_points.hpp"
#include "api/summary.hpp"

#include <grainlaw/grainlaw.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

using namespace grainlaw::core;

namespace {

constexpr double most_step = 0.5;  // largest_step [-]

std::string fault_of(const grainlaw_consolidation& how) {
  if (how.route != GRAINLAW_PROPORTIONAL && how.route != GRAINLAW_ISOTROPIC &&
      how.route != GRAINLAW_K0)
    return fmt::format("route is {}, expected GRAINLAW_PROPORTIONAL, _ISOTROPIC or _K0",
                       static_cast<int>(how.route));
  for (const double component : how.axis)
    if (!std::isfinite(component))
      return "axis is not finite, expected a vector, or 0 for the last";
  if (!(how.first_pressure >= 0 && std::isfinite(how.first_pressure)))
    return fmt::format("first_pressure is {}, expected at least 0 Pa", how.first_pressure);
  if (!(how.overconsolidation >= 1 && std::isfinite(how.overconsolidation)))
    return fmt::format("overconsolidation is {}, expected at least 1", how.overconsolidation);
  if (!(how.largest_step > 0 && how.largest_step <= most_step))
    return fmt::format("largest_step is {}, expected above 0 and at most {}", how.largest_step,
                       most_step);
  return {};
}

Consolidation read(const grainlaw_consolidation& given, int dimension) {
  Consolidation how;
  how.route = static_cast<StressRoute>(given.route);
  how.first_pressure = given.first_pressure;
  how.overconsolidation = given.overconsolidation;
  how.largest_step = given.largest_step;
  const auto last = static_cast<std::size_t>(dimension);
  const double length = std::hypot(given.axis[0], given.axis[1], last == 3 ? given.axis[2] : 0.0);
  if (length > 0)
    for (std::size_t k = 0; k < last; ++k) how.axis[k] = given.axis[k] / length;
  else
    how.axis[last - 1] = 1;
  return how;
}

// What the leaders of the points came to, one for each.
struct Led {
  std::vector<grainlaw_status> status;
  std::vector<grainlaw_report> report;
  std::vector<double> reached;
};

Led lead(SharedConsolidation& shared, const double* sigma, std::size_t square,
         const Consolidation& how, int threads) {
  const std::size_t n = shared.leaders.size();
  Led found{std::vector<grainlaw_status>(n),
            std::vector<grainlaw_report>(n, grainlaw_report_default()),
            std::vector<double>(n * square)};
  const auto one = [&](std::size_t k, grainlaw_report& report) {
    report = grainlaw_report_default();
    const api::MessageBuffer message{report.message, sizeof report.message};
    found.status[k] = api::guarded(
        [&] {
          const Consolidated result =
              consolidate(shared.leaders[k].state, sigma + shared.first[k] * square, how,
                          found.reached.data() + k * square);
          message.write(result.why);
          return result.status;
        },
        message);
    found.report[k] = report;
    return found.status[k];
  };
  const std::vector<IntegrationPoint*> leaders = shared.pointers();
  std::vector<std::size_t> order(n);
  evaluate_all(leaders, order, std::ref(one), threads);
  return found;
}

// Adds what is wrong with the points' stresses. BAD_ARGUMENT where anything is.
void check_stresses(const api::SomePoints& some, const double* sigma, std::size_t square,
                    const Consolidation& how, grainlaw_status* status, Summary& summary) {
  for (std::size_t k = 0; k < some.asked; ++k) {
    const std::string fault = fault_of_stress(some.points[k]->state, sigma + k * square, how);
    const grainlaw_status found = fault.empty() ? GRAINLAW_OK : GRAINLAW_BAD_ARGUMENT;
    grainlaw_report report = grainlaw_report_default();
    api::MessageBuffer{report.message, sizeof report.message}.write(fault);
    if (status != nullptr) status[k] = found;
    summary.add(k, found, report);
  }
}

}  // namespace

grainlaw_consolidation grainlaw_consolidation_default(void) {
  grainlaw_consolidation how{};
  how.size = sizeof how;
  how.route = GRAINLAW_PROPORTIONAL;
  how.overconsolidation = 1;
  how.largest_step = Consolidation{}.largest_step;
  return how;
}

grainlaw_status grainlaw_points_consolidate(grainlaw_points* handle, size_t n, const size_t* which,
                                            const double* sigma, const grainlaw_consolidation* how,
                                            double* reached, grainlaw_status* status, int threads,
                                            grainlaw_summary* summary) {
  if (const auto found = api::check_handle(handle); found != GRAINLAW_OK) return found;
  if (summary != nullptr && !api::known_summary_size(api::claimed_size(summary)))
    return GRAINLAW_BAD_REPORT;
  const bool known = how == nullptr || api::claimed_size(how) == sizeof *how;
  const grainlaw_consolidation given =
      how == nullptr || !known ? grainlaw_consolidation_default() : *how;
  const auto square = static_cast<std::size_t>(handle->dimension() * handle->dimension());
  const api::SomePoints some = api::distinct_points(*handle, n, which);
  Summary found;
  std::vector<IntegrationPoint> led;
  const auto refuse = [&](grainlaw_status why, const std::string& text) {
    found = api::refusal(why, text.empty() ? nullptr : text.c_str());
  };
  const api::MessageBuffer message{found.message, sizeof found.message};
  const grainlaw_status caught = api::guarded(
      [&] {
        if (!known) return refuse(GRAINLAW_BAD_REPORT, {});
        if (n > 0 && sigma == nullptr) return refuse(GRAINLAW_NULL_POINTER, {});
        if (!some.known)
          return refuse(GRAINLAW_BAD_ARGUMENT, api::fault_of_numbers(*handle, n, which));
        if (const std::string fault = fault_of(given); !fault.empty())
          return refuse(GRAINLAW_BAD_ARGUMENT, fault);
        const Consolidation route = read(given, handle->dimension());
        check_stresses(some, sigma, square, route, status, found);
        if (found.failed > 0 || n == 0) return;
        SharedConsolidation shared(some.points, sigma);
        const Led outcome = lead(shared, sigma, square, route, threads);
        for (std::size_t k = 0; k < n; ++k) {
          const std::size_t leader = shared.leader_of[k];
          if (status != nullptr) status[k] = outcome.status[leader];
          if (reached != nullptr)
            std::copy_n(outcome.reached.data() + leader * square, square, reached + k * square);
          found.add(k, outcome.status[leader], outcome.report[leader]);
        }
        if (found.failed == 0) led = shared.copies();
      },
      message);
  if (caught != GRAINLAW_OK) refuse(caught, std::string(found.message));
  found.first_failed = found.failed > 0 ? some.number(found.first_failed) : 0;
  if (found.status != GRAINLAW_OK) found.step_ratio = 0;
  const int rank = api::agree(handle->ranks, found);
  for (std::size_t k = 0; found.status == GRAINLAW_OK && k < led.size(); ++k)
    *some.points[k] = std::move(led[k]);
  api::write(found, rank, summary);
  return found.status;
}
