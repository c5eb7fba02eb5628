// Calls for some points of a set: their bytes, copies, and how many there are.
#include "api/some_points.hpp"

#include "api/guard.hpp"
#include "base/error.hpp"
#include "points/serialise_points.hpp"

#include <grainlaw/grainlaw.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

using namespace grainlaw::core;

namespace grainlaw::core::api {

SomePoints distinct_points(grainlaw_points& set, std::size_t n, const std::size_t* which) {
  SomePoints some;
  some.asked = n;
  some.which = which;
  if (n > set.points.size()) return some;
  if (which == nullptr) {
    some.points = PointSpan(set.points).first(n);
  } else {
    const auto sorted = set.order.begin();
    const auto end = std::copy_n(which, n, sorted);
    std::sort(sorted, end);
    if (n > 0 && *(end - 1) >= set.points.size()) return some;
    if (std::adjacent_find(sorted, end) != end) return some;
    std::transform(which, which + n, set.some.begin(),
                   [&](std::size_t k) { return set.points[k]; });
    some.points = PointSpan(set.some).first(n);
  }
  some.known = true;
  return some;
}

std::string fault_of_numbers(const grainlaw_points& set, std::size_t n, const std::size_t* which) {
  const std::size_t size = set.points.size();
  if (which == nullptr)
    return fmt::format("{} points, expected at most the {} of the set", n, size);
  for (std::size_t k = 0; k < n; ++k)
    if (which[k] >= size) return fmt::format("point {}, expected numbers below {}", which[k], size);
  return n > size ? fmt::format("{} points of a set of {}", n, size) : "a point comes twice";
}

bool all_in(const grainlaw_points& set, std::size_t n, const std::size_t* which) {
  const std::size_t size = set.points.size();
  if (which == nullptr) return n <= size;
  return std::all_of(which, which + n, [=](std::size_t k) { return k < size; });
}

grainlaw_status save_each(const grainlaw_points* handle, std::size_t n, const std::size_t* which,
                          void* bytes, std::size_t* offsets, const SizeOf& size_of,
                          const SaveOne& save) {
  if (const auto status = check_handle(handle); status != GRAINLAW_OK) return status;
  if (offsets == nullptr) return GRAINLAW_NULL_POINTER;
  if (!all_in(*handle, n, which)) return GRAINLAW_BAD_ARGUMENT;
  return guarded([&] {
    const auto point = [&](std::size_t k) -> const IntegrationPoint& {
      return *handle->points[which == nullptr ? k : which[k]];
    };
    if (bytes == nullptr) {
      offsets[0] = 0;
      for (std::size_t k = 0; k < n; ++k) offsets[k + 1] = offsets[k] + size_of(point(k));
      return GRAINLAW_OK;
    }
    for (std::size_t k = 0; k < n; ++k)
      if (offsets[k + 1] - offsets[k] != size_of(point(k))) return GRAINLAW_BUFFER_TOO_SMALL;
    for (std::size_t k = 0; k < n; ++k)
      save(point(k), {static_cast<std::byte*>(bytes) + offsets[k], offsets[k + 1] - offsets[k]});
    return GRAINLAW_OK;
  });
}

grainlaw_status load_each(grainlaw_points* handle, std::size_t n, const std::size_t* which,
                          const void* bytes, const std::size_t* offsets, const MessageBuffer& text,
                          const LoadAll& load) {
  text.write("");
  const auto refused = [&](grainlaw_status status) {
    text.write(grainlaw_status_text(status));
    return status;
  };
  if (const auto status = check_handle(handle); status != GRAINLAW_OK) return refused(status);
  if (n > 0 && (bytes == nullptr || offsets == nullptr)) return refused(GRAINLAW_NULL_POINTER);
  const SomePoints some = distinct_points(*handle, n, which);
  if (!some.known)
    return guarded([&] { throw Error(GRAINLAW_BAD_ARGUMENT, fault_of_numbers(*handle, n, which)); },
                   text);
  for (std::size_t k = 0; k < n; ++k)
    if (offsets[k + 1] < offsets[k]) return refused(GRAINLAW_BAD_ARGUMENT);
  return guarded(
      [&] {
        std::vector<std::span<const std::byte>> parts;
        parts.reserve(n);
        for (std::size_t k = 0; k < n; ++k)
          parts.emplace_back(static_cast<const std::byte*>(bytes) + offsets[k],
                             offsets[k + 1] - offsets[k]);
        load(some.points, parts, [&](std::size_t k) { return some.number(k); });
      },
      text);
}

}  // namespace grainlaw::core::api

grainlaw_status grainlaw_points_save_some(const grainlaw_points* handle, size_t n,
                                          const size_t* which, void* bytes, size_t* offsets) {
  return api::save_each(
      handle, n, which, bytes, offsets,
      [](const IntegrationPoint& point) { return saved_size(point); },
      [](const IntegrationPoint& point, std::span<std::byte> to) { save_point(point, to); });
}

grainlaw_status grainlaw_points_load_some(grainlaw_points* handle, size_t n, const size_t* which,
                                          const void* bytes, const size_t* offsets, char* message,
                                          size_t message_size) {
  return api::load_each(handle, n, which, bytes, offsets, {message, message_size}, load_each);
}

grainlaw_status grainlaw_points_resize(grainlaw_points* handle, size_t n,
                                       const grainlaw_material* material) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (material != nullptr) {
    if (const auto status = api::check_handle(material); status != GRAINLAW_OK) return status;
    if (material->material.index() != handle->material.index()) return GRAINLAW_BAD_ARGUMENT;
  }
  const AnyMaterial& of_new = material == nullptr ? handle->material : material->material;
  const std::size_t before = handle->points.size();
  const grainlaw_status status = api::guarded([&] {
    if (n > std::vector<std::size_t>().max_size()) throw std::bad_alloc();
    handle->reserve(n);
    while (handle->points.size() < n) handle->add({AnyState(of_new)});
  });
  handle->keep(status == GRAINLAW_OK ? n : before);
  return status;
}

grainlaw_status grainlaw_points_clone_some(grainlaw_points* to, size_t n, const size_t* which_to,
                                           const grainlaw_points* from, const size_t* which_from) {
  for (const grainlaw_points* handle : {static_cast<const grainlaw_points*>(to), from})
    if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  const api::SomePoints some = api::distinct_points(*to, n, which_to);
  if (!some.known || !api::all_in(*from, n, which_from) || to->dimension() != from->dimension())
    return GRAINLAW_BAD_ARGUMENT;
  return api::guarded([&] {
    std::vector<IntegrationPoint> copies;
    copies.reserve(n);
    for (std::size_t k = 0; k < n; ++k)
      copies.push_back(*from->points[which_from == nullptr ? k : which_from[k]]);
    for (std::size_t k = 0; k < n; ++k) *some.points[k] = std::move(copies[k]);
  });
}
