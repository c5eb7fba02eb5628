// Points of a set that a call names by number.
#pragma once

#include "api/guard.hpp"
#include "api/handle.hpp"
#include "points/serialise_points.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <string>

namespace grainlaw::core::api {

struct SomePoints {
  bool known = false;     // false: a number outside the set, or one that comes twice
  std::size_t asked = 0;  // numbers in the call
  PointSpan points;       // in the order of the call, empty unless known
  const std::size_t* which = nullptr;

  // Number in the set of the k-th point.
  [[nodiscard]] std::size_t number(std::size_t k) const { return which == nullptr ? k : which[k]; }
};

// Finds n points by number, each at most once; which may be null: 0 to n - 1. Uses the set's
// workspaces; does not allocate.
SomePoints distinct_points(grainlaw_points& set, std::size_t n, const std::size_t* which);

// What is wrong with numbers that are not known.
std::string fault_of_numbers(const grainlaw_points& set, std::size_t n, const std::size_t* which);

// Whether n numbers are all of points of the set; which may be null.
[[nodiscard]] bool all_in(const grainlaw_points& set, std::size_t n, const std::size_t* which);

// The calls of one signature that write bytes of some points, and those that read them.
using SizeOf = std::function<std::size_t(const IntegrationPoint&)>;
using SaveOne = std::function<void(const IntegrationPoint&, std::span<std::byte>)>;
grainlaw_status save_each(const grainlaw_points* handle, std::size_t n, const std::size_t* which,
                          void* bytes, std::size_t* offsets, const SizeOf& size_of,
                          const SaveOne& save);
using LoadAll =
    std::function<void(PointSpan, std::span<const std::span<const std::byte>>, const NumberOf&)>;
grainlaw_status load_each(grainlaw_points* handle, std::size_t n, const std::size_t* which,
                          const void* bytes, const std::size_t* offsets, const MessageBuffer& text,
                          const LoadAll& load);

}  // namespace grainlaw::core::api
