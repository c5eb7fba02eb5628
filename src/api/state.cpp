// States: creation, copies, bytes and measures.
#include "state/any_state.hpp"

#include "api/buffer.hpp"
#include "api/guard.hpp"
#include "api/handle.hpp"
#include "points/serialise_points.hpp"

#include <grainlaw/grainlaw.h>

#include <cstddef>

using namespace grainlaw::core;

grainlaw_status grainlaw_state_create(const grainlaw_material* handle, grainlaw_state** out) {
  if (out == nullptr) return GRAINLAW_NULL_POINTER;
  *out = nullptr;
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  return api::guarded([&] { *out = new grainlaw_state(AnyState(handle->material)); });
}

grainlaw_status grainlaw_state_clone(const grainlaw_state* handle, grainlaw_state** out) {
  if (out == nullptr) return GRAINLAW_NULL_POINTER;
  *out = nullptr;
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  return api::guarded([&] { *out = new grainlaw_state(handle->point); });
}

void grainlaw_state_destroy(grainlaw_state* handle) {
  if (api::check_owned(handle) == GRAINLAW_OK) delete handle;
}

grainlaw_status grainlaw_state_save(const grainlaw_state* handle, void* bytes, size_t* size) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (size == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] {
    const AnyState& state = handle->point.state;
    return api::save_to(bytes, size, state.saved_size(), [&](auto to) { state.save(to); });
  });
}

grainlaw_status grainlaw_state_load(grainlaw_state* handle, const void* bytes, size_t size) {
  if (const auto status = api::check_owned(handle); status != GRAINLAW_OK) return status;
  if (bytes == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] {
    restore_point(handle->point,
                  read_point(handle->point, {static_cast<const std::byte*>(bytes), size}));
  });
}

grainlaw_status grainlaw_state_measure(const grainlaw_state* handle, grainlaw_measure what,
                                       double* value, size_t* count) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (count == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] { return api::measure_state(handle->point.state, what, value, count); });
}
