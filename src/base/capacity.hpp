// Growth of vectors that are reused from call to call: after a few calls they allocate no more.
#pragma once

#include <algorithm>
#include <cstddef>

namespace grainlaw::core {

// Spare capacity as a divisor of the size: a vector that grows reserves size / divisor more.
// `thread_capacity` serves the memory of a thread, `state_capacity` that of the many states.
constexpr std::size_t thread_capacity = 2;
constexpr std::size_t state_capacity = 8;

template <class Vector>
void reserve_with_capacity(Vector& vector, std::size_t size, std::size_t part = thread_capacity) {
  if (vector.capacity() < size) vector.reserve(size + size / part);
}

template <class Vector>
void resize_with_capacity(Vector& vector, std::size_t size, std::size_t part = thread_capacity) {
  reserve_with_capacity(vector, size, part);
  vector.resize(size);
}

template <class Vector>
void copy_with_capacity(const Vector& from, Vector& to, std::size_t part = thread_capacity) {
  resize_with_capacity(to, from.size(), part);
  std::copy(from.begin(), from.end(), to.begin());
}

// Reserves spare capacity for a vector that was filled by push_back.
template <class Vector>
void keep_capacity(Vector& vector) {
  if (vector.capacity() < vector.size() + vector.size() / 4) {
    vector.reserve(vector.size() + vector.size() / 2);
  }
}

}  // namespace grainlaw::core
