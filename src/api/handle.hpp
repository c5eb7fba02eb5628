// C handles, and detection of dead or foreign ones.
#pragma once

#include "points/points.hpp"

#include <grainlaw/grainlaw.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

namespace grainlaw::core::api {

// An object whose address identifies this copy of the library. Handles of another copy in the
// process may have another layout.
inline const char this_copy = 0;

// First word of every handle, zeroed by the destructor. It detects destroyed handles and handles of
// another kind, until their memory is used again.
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

}  // namespace grainlaw::core::api

struct grainlaw_material {
  explicit grainlaw_material(grainlaw::core::AnyMaterial shared) : material(std::move(shared)) {}

  grainlaw::core::api::Magic<0x6c61'6972'6574'616dULL> magic;
  grainlaw::core::AnyMaterial material;
};

struct grainlaw_state {
  explicit grainlaw_state(grainlaw::core::AnyState initial, long cost = 0, bool in_set = false)
      : point{std::move(initial), cost}, of_set(in_set) {}

  grainlaw::core::api::Magic<0x6574'6174'735f'6c67ULL> magic;
  grainlaw::core::IntegrationPoint point;
  bool of_set;  // a set owns it
};

struct grainlaw_points {
  explicit grainlaw_points(std::size_t n) : order(n) { points.reserve(n); }
  void add(grainlaw::core::AnyState initial, long cost = 0) {
    points.push_back(&states.emplace_back(std::move(initial), cost, true).point);
  }

  grainlaw::core::api::Magic<0x7374'6e69'6f70'6c67ULL> magic;
  std::deque<grainlaw_state> states;  // stable addresses: hosts borrow them
  std::vector<grainlaw::core::IntegrationPoint*> points;
  std::vector<std::size_t> order;  // workspace of evaluations
};

namespace grainlaw::core::api {

// Returns OK, NULL_POINTER or BAD_HANDLE.
template <class Handle>
grainlaw_status check_handle(const Handle* handle) {
  if (handle == nullptr) return GRAINLAW_NULL_POINTER;
  return handle->magic.alive() ? GRAINLAW_OK : GRAINLAW_BAD_HANDLE;
}

// check_handle() for calls that change a state; a state of a set is refused.
inline grainlaw_status check_owned(const grainlaw_state* handle) {
  const grainlaw_status status = check_handle(handle);
  return status == GRAINLAW_OK && handle->of_set ? GRAINLAW_BAD_HANDLE : status;
}

}  // namespace grainlaw::core::api
