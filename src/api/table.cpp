// Tables of points: which state a call starts from, its answer, and bytes.
#include "points/table.hpp"

#include "api/buffer.hpp"
#include "api/evaluate_point.hpp"
#include "api/guard.hpp"
#include "api/handle.hpp"
#include "api/report.hpp"
#include "base/error.hpp"

#include <grainlaw/grainlaw.h>

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

using namespace grainlaw::core;

namespace {

grainlaw_status evaluate_at(IntegrationPoint& point, const double* F, std::string& why) {
  grainlaw_report report;
  const grainlaw_status status = api::evaluate_point(point, F, 0, nullptr, nullptr, report);
  if (status != GRAINLAW_OK) why = report.message;
  return status;
}

struct Call {
  TableStart start;
  const double* F;
  double time_step;
  unsigned want;
  double* P;
  double* A;
};

// Evaluates a point that no other call works on. Throws Error for a start of no known state.
grainlaw_status evaluate(TablePoint& at, const Call& call, grainlaw_report& report) {
  start_from(at, call.start, evaluate_at);
  at.trial.clear();
  at.point.state.set_time_step(call.time_step);
  const auto square = static_cast<std::size_t>(at.point.state.dimension()) *
                      static_cast<std::size_t>(at.point.state.dimension());
  std::vector<double> F = call.F == nullptr ? at.point.state.committed_deformation()
                                            : std::vector(call.F, call.F + square);
  const grainlaw_status status =
      api::evaluate_point(at.point, F.data(), call.want, call.P, call.A, report);
  if (call.F == nullptr) at.point.state.revert();
  if (call.F == nullptr || status != GRAINLAW_OK) return status;
  at.trial = std::move(F);
  at.known = true;
  return status;
}

}  // namespace

grainlaw_status grainlaw_table_create(const grainlaw_material* handle, grainlaw_table** out) {
  if (out == nullptr) return GRAINLAW_NULL_POINTER;
  *out = nullptr;
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  return api::guarded([&] { *out = new grainlaw_table(handle->material); });
}

void grainlaw_table_destroy(grainlaw_table* handle) {
  if (api::check_handle(handle) == GRAINLAW_OK) delete handle;
}

size_t grainlaw_table_size(const grainlaw_table* handle) {
  return api::check_handle(handle) == GRAINLAW_OK ? handle->table.size() : 0;
}

grainlaw_status grainlaw_table_evaluate(grainlaw_table* handle, long long element, long long point,
                                        double* token, const double* F0, const double* F,
                                        double time_step, unsigned want, double* P, double* A,
                                        grainlaw_report* report) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (const auto status = api::Reports(report).check(1); status != GRAINLAW_OK) return status;
  grainlaw_report full = grainlaw_report_default();
  const grainlaw_status status = api::guarded(
      [&] {
        if (!api::known_want(want)) throw Error(GRAINLAW_BAD_ARGUMENT, api::fault_of_want(want));
        if (!(time_step >= 0 && std::isfinite(time_step)))
          throw Error(GRAINLAW_BAD_ARGUMENT,
                      fmt::format("time_step is {}, expected a finite number >= 0", time_step));
        const PointKey key{element, point};
        const std::shared_ptr<TablePoint> at = handle->table.find_or_make(key);
        const std::unique_lock lock(at->in_use, std::try_to_lock);
        if (!lock)
          throw Error(GRAINLAW_BAD_ARGUMENT, text_of(key) + ": two threads ask for it at once");
        const grainlaw_status found = evaluate(*at, {{token, F0}, F, time_step, want, P, A}, full);
        if (found == GRAINLAW_OK && F != nullptr && token != nullptr)
          *token = static_cast<double>(at->increments + 1);
        return found;
      },
      {full.message, sizeof full.message});
  if (report != nullptr) api::copy_out(full, report);
  return status;
}

grainlaw_status grainlaw_table_measure(const grainlaw_table* handle, long long element,
                                       long long point, grainlaw_measure what, double* value,
                                       size_t* count) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (count == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] {
    const std::shared_ptr<TablePoint> at = handle->table.find({element, point});
    return api::measure_state(at->point.state, what, value, count);
  });
}

grainlaw_status grainlaw_table_forget(grainlaw_table* handle, long long element, long long point) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  return api::guarded([&] { handle->table.forget({element, point}); });
}

grainlaw_status grainlaw_table_save(const grainlaw_table* handle, void* bytes, size_t* size) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (size == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] {
    const PointTable& table = handle->table;
    return api::save_to(bytes, size, table.saved_size(), [&](auto to) { table.save(to); });
  });
}

grainlaw_status grainlaw_table_load(grainlaw_table* handle, const void* bytes, size_t size,
                                    char* message, size_t message_size) {
  const api::MessageBuffer text{message, message_size};
  text.write("");
  const auto status = bytes == nullptr ? GRAINLAW_NULL_POINTER : api::check_handle(handle);
  if (status != GRAINLAW_OK) return text.write(grainlaw_status_text(status)), status;
  return api::guarded(
      [&] {
        handle->table.load({static_cast<const std::byte*>(bytes), size});
      },
      text);
}
