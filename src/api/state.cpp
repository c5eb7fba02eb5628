// States: creation, copies, bytes and measures.
#include "state/state.hpp"

#include "api/guard.hpp"
#include "api/handle.hpp"
#include "homogenise/measures.hpp"
#include "state/serialise.hpp"

#include <grainlaw/grainlaw.h>

#include <cstddef>

using namespace grainlaw;

grainlaw_status grainlaw_state_create(const grainlaw_material* handle, grainlaw_state** out) {
  if (out == nullptr) return GRAINLAW_NULL_POINTER;
  *out = nullptr;
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  return api::guarded([&] { *out = new grainlaw_state(State<2>(handle->material)); });
}

grainlaw_status grainlaw_state_clone(const grainlaw_state* handle, grainlaw_state** out) {
  if (out == nullptr) return GRAINLAW_NULL_POINTER;
  *out = nullptr;
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  return api::guarded([&] { *out = new grainlaw_state(handle->state, handle->last_cost); });
}

void grainlaw_state_destroy(grainlaw_state* handle) {
  if (api::check_handle(handle) == GRAINLAW_OK) delete handle;
}

grainlaw_status grainlaw_state_save(const grainlaw_state* handle, void* bytes, size_t* size) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (size == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] {
    const Material<2>& material = handle->state.material();
    const Configuration<2>& committed = handle->state.committed();
    const std::size_t need = saved_size(material, committed);
    if (bytes != nullptr) {
      if (*size < need) return GRAINLAW_BUFFER_TOO_SMALL;
      save_configuration(material, committed, {static_cast<std::byte*>(bytes), need});
    }
    *size = need;
    return GRAINLAW_OK;
  });
}

grainlaw_status grainlaw_state_load(grainlaw_state* handle, const void* bytes, size_t size) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (bytes == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] {
    handle->state.restore(load_configuration<2>(handle->state.material(),
                                                {static_cast<const std::byte*>(bytes), size}));
  });
}

grainlaw_status grainlaw_state_measure(const grainlaw_state* handle, grainlaw_measure what,
                                       double* value, size_t* count) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (count == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] {
    const Material<2>& material = handle->state.material();
    const int components = measure_count(material.packing.dimension, what);
    if (components < 0) return GRAINLAW_BAD_ARGUMENT;
    const auto need = static_cast<std::size_t>(components);
    if (value != nullptr) {
      if (*count < need) return GRAINLAW_BUFFER_TOO_SMALL;
      measure(material.problem(), handle->state.current(), what, value);
    }
    *count = need;
    return GRAINLAW_OK;
  });
}
