// Sets of points: made, committed, saved, measured.
#include "points/points.hpp"

#include "api/buffer.hpp"
#include "api/guard.hpp"
#include "api/handle.hpp"
#include "homogenise/measures.hpp"
#include "points/serialise_points.hpp"

#include <grainlaw/grainlaw.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <new>
#include <vector>

using namespace grainlaw::core;

namespace {

// Creates a set; fill(set) adds its n points.
template <class Fill>
grainlaw_status create(grainlaw_points** out, const AnyMaterial& material, std::size_t n,
                       Fill&& fill) {
  return api::guarded([&] {
    if (n > std::vector<std::size_t>().max_size()) throw std::bad_alloc();
    auto set = std::make_unique<grainlaw_points>(material, n);
    fill(*set);
    *out = set.release();
  });
}

grainlaw_status measure_points(PointSpan points, grainlaw_measure what, double* values,
                               size_t* count) {
  std::size_t each = 0;  // components of the measure
  if (!points.empty()) {
    const int components = measure_count(points[0]->state.dimension(), what);
    if (components < 0) return GRAINLAW_BAD_ARGUMENT;
    each = static_cast<std::size_t>(components);
  }
  const std::size_t need = each * points.size();
  if (values != nullptr) {
    if (*count < need) return GRAINLAW_BUFFER_TOO_SMALL;
    std::vector<double> found(need);  // complete before anything is written
    for (std::size_t k = 0; k < points.size(); ++k)
      points[k]->state.measure(what, found.data() + k * each);
    std::copy(found.begin(), found.end(), values);
  }
  *count = need;
  return GRAINLAW_OK;
}

}  // namespace

grainlaw_status grainlaw_points_create(const grainlaw_material* handle, size_t n,
                                       grainlaw_points** out) {
  if (out == nullptr) return GRAINLAW_NULL_POINTER;
  *out = nullptr;
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  return create(out, handle->material, n, [&](grainlaw_points& set) {
    for (std::size_t k = 0; k < n; ++k) set.add({AnyState(handle->material)});
  });
}

grainlaw_status grainlaw_points_clone(const grainlaw_points* handle, grainlaw_points** out) {
  if (out == nullptr) return GRAINLAW_NULL_POINTER;
  *out = nullptr;
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  return create(out, handle->material, handle->points.size(), [&](grainlaw_points& set) {
    for (const IntegrationPoint* point : handle->points) set.add(*point);
  });
}

void grainlaw_points_destroy(grainlaw_points* handle) {
  if (api::check_handle(handle) == GRAINLAW_OK) delete handle;
}

size_t grainlaw_points_size(const grainlaw_points* handle) {
  return api::check_handle(handle) == GRAINLAW_OK ? handle->points.size() : 0;
}

const grainlaw_state* grainlaw_points_state(const grainlaw_points* handle, size_t point) {
  return point < grainlaw_points_size(handle) ? &handle->states[point] : nullptr;
}

grainlaw_status grainlaw_points_set_time_step(grainlaw_points* handle, double time_step) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (!(time_step >= 0 && std::isfinite(time_step))) return GRAINLAW_BAD_ARGUMENT;
  for (IntegrationPoint* const point : handle->points) point->state.set_time_step(time_step);
  return GRAINLAW_OK;
}

grainlaw_status grainlaw_points_commit(grainlaw_points* handle) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (!api::agree(handle->ranks, have_trials(handle->points))) return GRAINLAW_NO_TRIAL;
  commit_all(handle->points);
  return GRAINLAW_OK;
}

grainlaw_status grainlaw_points_revert(grainlaw_points* handle) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  revert_all(handle->points);
  return GRAINLAW_OK;
}

grainlaw_status grainlaw_points_save(const grainlaw_points* handle, void* bytes, size_t* size) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (size == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] {
    return api::save_to(bytes, size, saved_size(handle->points),
                        [&](auto to) { save_points(handle->points, to); });
  });
}

grainlaw_status grainlaw_points_load(grainlaw_points* handle, const void* bytes, size_t size,
                                     char* message, size_t message_size) {
  const api::MessageBuffer text{message, message_size};
  text.write("");
  const auto refused = [&](grainlaw_status status) {
    text.write(grainlaw_status_text(status));
    return status;
  };
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return refused(status);
  if (bytes == nullptr) return refused(GRAINLAW_NULL_POINTER);
  return api::guarded(
      [&] {
        load_points(handle->points, {static_cast<const std::byte*>(bytes), size});
      },
      text);
}

grainlaw_status grainlaw_points_measure(const grainlaw_points* handle, grainlaw_measure what,
                                        double* values, size_t* count) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (count == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] { return measure_points(handle->points, what, values, count); });
}

grainlaw_status grainlaw_points_cost(const grainlaw_points* handle, double* seconds) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (seconds == nullptr && !handle->points.empty()) return GRAINLAW_NULL_POINTER;
  for (const IntegrationPoint* point : handle->points) *seconds++ = point->seconds;
  return GRAINLAW_OK;
}
