// Buffers of callers: asked for their size first, then filled.
#pragma once

#include "homogenise/measures.hpp"
#include "state/any_state.hpp"

#include <grainlaw/grainlaw.h>

#include <cstddef>
#include <span>

namespace grainlaw::core::api {

// Fills the caller's buffer by save(bytes), unless it is null or too short; sets *size to what is
// needed.
template <class Save>
grainlaw_status save_to(void* bytes, std::size_t* size, std::size_t need, Save&& save) {
  if (bytes != nullptr) {
    if (*size < need) return GRAINLAW_BUFFER_TOO_SMALL;
    save(std::span(static_cast<std::byte*>(bytes), need));
  }
  *size = need;
  return GRAINLAW_OK;
}

// Fills the caller's array with a measure in the same way.
inline grainlaw_status measure_state(const AnyState& state, grainlaw_measure what, double* value,
                                     std::size_t* count) {
  const int components = measure_count(state.dimension(), what);
  if (components < 0) return GRAINLAW_BAD_ARGUMENT;
  const auto need = static_cast<std::size_t>(components);
  if (value != nullptr) {
    if (*count < need) return GRAINLAW_BUFFER_TOO_SMALL;
    state.measure(what, value);
  }
  *count = need;
  return GRAINLAW_OK;
}

}  // namespace grainlaw::core::api
