// The points of a library that a host loaded: made by the first call, whichever thread it is in,
// and kept behind the pointer `points` of the library's own C struct {name, material, points}.
#pragma once

#include <atomic>
#include <mutex>

namespace grainlaw::adapters {

template <class Points, class Library>
Points& points_of(Library* library) {
  const std::atomic_ref<void*> points(library->points);
  if (void* made = points.load(std::memory_order_acquire); made != nullptr) {
    return *static_cast<Points*>(made);
  }
  static std::mutex making;
  const std::lock_guard lock(making);
  if (points.load() == nullptr) {
    points.store(new Points(library->name, library->material, library));
  }
  return *static_cast<Points*>(points.load());
}

// No other thread may be inside.
template <class Points, class Library>
void release_points(Library* library) {
  if (library == nullptr) return;
  delete static_cast<Points*>(library->points);
  library->points = nullptr;
}

}  // namespace grainlaw::adapters
