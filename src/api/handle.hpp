// What a C handle points to, and how a dead or foreign one is told.
#pragma once

#include "material/material.hpp"
#include "state/state.hpp"

#include <grainlaw/grainlaw.h>

#include <cstdint>
#include <memory>
#include <utility>

namespace grainlaw::api {

// Its address tells this copy of the library from others in the process, whose handles may be laid
// out in another way.
inline const char this_copy = 0;

// First word of every handle; the destructor blanks it. A handle that was destroyed, or is of the
// other kind, is told by it as long as its memory has not been given to something else.
template <std::uint64_t kind>
class Magic {
 public:
  Magic() = default;
  ~Magic() { *static_cast<volatile std::uint64_t*>(&word_) = 0; }  // volatile: not optimised away
  Magic(const Magic&) = delete;
  Magic& operator=(const Magic&) = delete;
  [[nodiscard]] bool alive() const { return word_ == live(); }

 private:
  static std::uint64_t live() { return kind ^ reinterpret_cast<std::uintptr_t>(&this_copy); }

  std::uint64_t word_ = live();
};

}  // namespace grainlaw::api

struct grainlaw_material {
  explicit grainlaw_material(std::shared_ptr<const grainlaw::Material<2>> shared)
      : material(std::move(shared)) {}

  grainlaw::api::Magic<0x6c61'6972'6574'616dULL> magic;
  std::shared_ptr<const grainlaw::Material<2>> material;
};

struct grainlaw_state {
  explicit grainlaw_state(grainlaw::State<2> initial, long cost = 0)
      : state(std::move(initial)), last_cost(cost) {}

  grainlaw::api::Magic<0x6574'6174'735f'6c67ULL> magic;
  grainlaw::State<2> state;
  long last_cost;  // of the last evaluation in relaxation steps; a batch begins with the dearest
};

namespace grainlaw::api {

// OK, NULL_POINTER or BAD_HANDLE.
template <class Handle>
grainlaw_status check_handle(const Handle* handle) {
  if (handle == nullptr) return GRAINLAW_NULL_POINTER;
  return handle->magic.alive() ? GRAINLAW_OK : GRAINLAW_BAD_HANDLE;
}

}  // namespace grainlaw::api
