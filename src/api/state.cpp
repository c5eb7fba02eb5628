// States: creation, copies, bytes and measures.
#include "state/any_state.hpp"

#include "api/guard.hpp"
#include "api/handle.hpp"
#include "homogenise/measures.hpp"

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
  return api::guarded([&] { *out = new grainlaw_state(handle->point.state, handle->point.cost); });
}

void grainlaw_state_destroy(grainlaw_state* handle) {
  if (api::check_owned(handle) == GRAINLAW_OK) delete handle;
}

grainlaw_status grainlaw_state_save(const grainlaw_state* handle, void* bytes, size_t* size) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (size == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] {
    const AnyState& state = handle->point.state;
    const std::size_t need = state.saved_size();
    if (bytes != nullptr) {
      if (*size < need) return GRAINLAW_BUFFER_TOO_SMALL;
      state.save({static_cast<std::byte*>(bytes), need});
    }
    *size = need;
    return GRAINLAW_OK;
  });
}

grainlaw_status grainlaw_state_load(grainlaw_state* handle, const void* bytes, size_t size) {
  if (const auto status = api::check_owned(handle); status != GRAINLAW_OK) return status;
  if (bytes == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] {
    AnyState& state = handle->point.state;
    state.restore(state.read({static_cast<const std::byte*>(bytes), size}));
  });
}

grainlaw_status grainlaw_state_measure(const grainlaw_state* handle, grainlaw_measure what,
                                       double* value, size_t* count) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (count == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] {
    const AnyState& state = handle->point.state;
    const int components = measure_count(state.dimension(), what);
    if (components < 0) return GRAINLAW_BAD_ARGUMENT;
    const auto need = static_cast<std::size_t>(components);
    if (value != nullptr) {
      if (*count < need) return GRAINLAW_BUFFER_TOO_SMALL;
      state.measure(what, value);
    }
    *count = need;
    return GRAINLAW_OK;
  });
}
