// C handles, and detection of dead or foreign ones.
#pragma once

#include "api/ranks.hpp"
#include "points/march.hpp"
#include "points/points.hpp"
#include "points/table.hpp"

#include <grainlaw/grainlaw.h>

#include <algorithm>
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
  explicit grainlaw_state(grainlaw::core::AnyState initial)
      : grainlaw_state(grainlaw::core::IntegrationPoint{std::move(initial)}) {}
  explicit grainlaw_state(grainlaw::core::IntegrationPoint initial, bool in_set = false)
      : point(std::move(initial)), of_set(in_set) {
    point.keeps_tangents = in_set;
    if (!in_set) point.committed_tangent = point.trial_tangent = {};
  }

  grainlaw::core::api::Magic<0x6574'6174'735f'6c67ULL> magic;
  grainlaw::core::IntegrationPoint point;
  bool of_set;  // a set owns it
};

struct grainlaw_points {
  grainlaw_points(grainlaw::core::AnyMaterial first, std::size_t n) : material(std::move(first)) {
    reserve(n);
  }
  // Makes room for n points.
  void reserve(std::size_t n) {
    points.reserve(n);
    some.resize(std::max(n, some.size()));
    order.resize(some.size());
  }
  void add(grainlaw::core::IntegrationPoint initial) {
    points.push_back(&states.emplace_back(std::move(initial), true).point);
  }
  // Drops points from n on.
  void keep(std::size_t n) {
    while (states.size() > n) states.pop_back();
    points.resize(n);
  }
  [[nodiscard]] int dimension() const { return material.index() == 0 ? 2 : 3; }

  grainlaw::core::api::Magic<0x7374'6e69'6f70'6c67ULL> magic;
  grainlaw::core::AnyMaterial material;  // of points that are added without one
  std::deque<grainlaw_state> states;     // stable addresses: hosts borrow them
  std::vector<grainlaw::core::IntegrationPoint*> points;
  std::vector<grainlaw::core::IntegrationPoint*> some;  // workspace of calls for some points
  std::vector<std::size_t> order;                       // workspace of evaluations
  grainlaw::core::api::Ranks ranks;
};

struct grainlaw_table {
  explicit grainlaw_table(grainlaw::core::AnyMaterial material) : table(std::move(material)) {}

  grainlaw::core::api::Magic<0x656c'6261'745f'6c67ULL> magic;
  grainlaw::core::PointTable table;
};

struct grainlaw_march {
  grainlaw_march(const grainlaw_march_options& options, grainlaw_points* of_host)
      : march(options), set(of_host) {}

  grainlaw::core::api::Magic<0x6863'7261'6d5f'6c67ULL> magic;
  grainlaw::core::March march;
  grainlaw_points* set;  // may be null
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
