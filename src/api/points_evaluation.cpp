// Evaluations of sets: all points, some of them, and what was committed; agreed by ranks.
#include "api/evaluate_point.hpp"
#include "api/evaluate_points.hpp"
#include "api/guard.hpp"
#include "api/handle.hpp"
#include "api/report.hpp"
#include "api/some_points.hpp"
#include "api/summary.hpp"

#include <grainlaw/grainlaw.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>

using namespace grainlaw::core;

namespace {

// Evaluates points of a set unless they are refused, with the outcome of all ranks. call(points,
// order) returns the summary of points numbered as in the call; why() says what is wrong with one
// refused.
template <class Why, class Call>
grainlaw_status evaluate(grainlaw_points& set, api::SomePoints some, grainlaw_status checked,
                         const Why& why, grainlaw_status* status, grainlaw_summary* summary,
                         Call&& call) {
  const bool unknown = summary != nullptr && !api::known_summary_size(api::claimed_size(summary));
  if (unknown) checked = GRAINLAW_BAD_REPORT;
  Summary found = api::refusal(checked);
  if (checked == GRAINLAW_OK) {
    found = call(some.points, std::span(set.order.data(), some.points.size()));
    found.first_failed = some.number(found.first_failed);
  } else if (!unknown) {
    if (status != nullptr) std::fill_n(status, some.asked, checked);
    api::guarded([&] {
      if (const std::string text = why(); !text.empty())
        found = api::refusal(checked, text.c_str());
    });
  }
  const int rank = api::agree(set.ranks, found);
  if (!unknown) api::write(found, rank, summary);
  return unknown ? GRAINLAW_BAD_REPORT : found.status;
}

}  // namespace

grainlaw_summary grainlaw_summary_default(void) {
  grainlaw_summary summary{};
  summary.size = sizeof summary;
  summary.step_ratio = 1;
  summary.first_failed = -1;
  summary.rank = -1;
  return summary;
}

grainlaw_status grainlaw_points_evaluate(grainlaw_points* handle, const double* F, unsigned want,
                                         double* P, double* A, grainlaw_status* status,
                                         grainlaw_report* reports, int threads,
                                         grainlaw_summary* summary) {
  return grainlaw_points_evaluate_some(handle, grainlaw_points_size(handle), nullptr, F, 0, want, P,
                                       0, A, 0, status, reports, threads, summary);
}

grainlaw_status grainlaw_points_evaluate_some(grainlaw_points* handle, size_t n,
                                              const size_t* which, const double* F, size_t F_stride,
                                              unsigned want, double* P, size_t P_stride, double* A,
                                              size_t A_stride, grainlaw_status* status,
                                              grainlaw_report* reports, int threads,
                                              grainlaw_summary* summary) {
  if (const auto found = api::check_handle(handle); found != GRAINLAW_OK) return found;
  const api::SomePoints some = api::distinct_points(*handle, n, which);
  const api::PointArrays arrays{
      F, want, P, A, status, api::Reports(reports), {F_stride, P_stride, A_stride}};
  const grainlaw_status checked =
      some.known ? api::check(arrays, n, handle->dimension()) : GRAINLAW_BAD_ARGUMENT;
  const auto why = [&] {
    return some.known ? api::fault_of(arrays, handle->dimension())
                      : api::fault_of_numbers(*handle, n, which);
  };
  return evaluate(*handle, some, checked, why, status, summary,
                  [&](PointSpan points, std::span<std::size_t> order) {
                    return api::evaluate_points(points, order, arrays, threads);
                  });
}

grainlaw_status grainlaw_points_answer(grainlaw_points* handle, unsigned want, double* P, double* A,
                                       int threads, grainlaw_summary* summary) {
  if (const auto found = api::check_handle(handle); found != GRAINLAW_OK) return found;
  const auto square = static_cast<std::size_t>(handle->dimension() * handle->dimension());
  const TangentKind kind = A == nullptr ? TangentKind::none : api::tangent_kind(want);
  const api::SomePoints all = api::distinct_points(*handle, handle->points.size(), nullptr);
  const auto checked = api::known_want(want) ? GRAINLAW_OK : GRAINLAW_BAD_ARGUMENT;
  const auto why = [want] { return api::fault_of_want(want); };
  return evaluate(*handle, all, checked, why, nullptr, summary,
                  [&](PointSpan points, std::span<std::size_t> order) {
                    const api::CancellationOff cancellation;
                    const auto answer = [&](std::size_t k, grainlaw_report& report) {
                      report = grainlaw_report_default();
                      return api::guarded(
                          [&] {
                            return points[k]->answer(
                                kind, P == nullptr ? nullptr : P + k * square,
                                A == nullptr ? nullptr : A + k * square * square, report);
                          },
                          {report.message, sizeof report.message});
                    };
                    return evaluate_all(points, order, std::ref(answer), threads);
                  });
}

grainlaw_status grainlaw_points_share(grainlaw_points* handle, int rank, grainlaw_reduce reduce,
                                      void* context) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (reduce != nullptr && rank < 0) return GRAINLAW_BAD_ARGUMENT;
  handle->ranks = {reduce, context, rank};
  return GRAINLAW_OK;
}

grainlaw_status grainlaw_points_agree(grainlaw_points* handle, grainlaw_status mine, char* message,
                                      size_t message_size) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  Summary summary;
  summary.status = mine;
  if (mine != GRAINLAW_OK && message != nullptr && message_size > 0) {
    const api::MessageBuffer text{summary.message, sizeof summary.message};
    text.write({message, strnlen(message, message_size)});
  }
  api::agree(handle->ranks, summary);
  api::MessageBuffer{message, message_size}.write(summary.message);
  return summary.status;
}
