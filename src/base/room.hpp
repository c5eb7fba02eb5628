// Growth of vectors that are reused from call to call: after a few calls they allocate no more.
#pragma once

#include <algorithm>
#include <cstddef>

namespace grainlaw::core {

// Spare capacity as a divisor of the size: a vector that grows reserves size / divisor more.
// `plenty` serves the memory of a thread, `little` that of the many states.
constexpr std::size_t plenty = 2;
constexpr std::size_t little = 8;

template <class Vector>
void reserve_with_room(Vector& vector, std::size_t size, std::size_t part = plenty) {
  if (vector.capacity() < size) vector.reserve(size + size / part);
}

template <class Vector>
void resize_with_room(Vector& vector, std::size_t size, std::size_t part = plenty) {
  reserve_with_room(vector, size, part);
  vector.resize(size);
}

template <class Vector>
void copy_with_room(const Vector& from, Vector& to, std::size_t part = plenty) {
  resize_with_room(to, from.size(), part);
  std::copy(from.begin(), from.end(), to.begin());
}

// Reserves spare capacity for a vector that was filled by push_back.
template <class Vector>
void keep_room(Vector& vector) {
  if (vector.capacity() < vector.size() + vector.size() / 4) {
    vector.reserve(vector.size() + vector.size() / 2);
  }
}

}  // namespace grainlaw::core
