// Writers of states to files.
#include "api/guard.hpp"
#include "api/handle.hpp"

#include <grainlaw/grainlaw.h>

using namespace grainlaw::core;

grainlaw_status grainlaw_state_write_vtk(const grainlaw_state* handle, const char* path) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (path == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] { handle->point.state.write_force_chains(path); });
}

grainlaw_status grainlaw_state_write_packing(const grainlaw_state* handle, const char* prefix) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (prefix == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] { handle->point.state.write_packing(prefix); });
}
