#include "linear/largest.hpp"

#include "base/simd.hpp"

#include <limits>

namespace grainlaw::core {

namespace {

template <std::size_t width>
GRAINLAW_INLINE void find_largest(const double* values, std::size_t count, double* result) {
  simd::Lanes<width> most{};
  simd::Lanes<width> poison{};
  for (std::size_t k = 0; k < count; ++k) {
    const auto v = simd::load<width>(values + k * width);
    most = simd::largest(most, simd::magnitude(v));
    poison += v * 0.0;
  }
  for (std::size_t k = 0; k < width; ++k) {
    result[k] = poison[k] == 0 ? most[k] : std::numeric_limits<double>::infinity();
  }
}
// Overloads by width, because templates have no clones per instruction set.
GRAINLAW_CLONES void largest_of_4(const double* values, std::size_t count, double* result) {
  find_largest<4>(values, count, result);
}
GRAINLAW_CLONES void largest_of_8(const double* values, std::size_t count, double* result) {
  find_largest<8>(values, count, result);
}

}  // namespace

template <>
void largest_by_lane<4>(const double* values, std::size_t count, double* result) {
  largest_of_4(values, count, result);
}
template <>
void largest_by_lane<8>(const double* values, std::size_t count, double* result) {
  largest_of_8(values, count, result);
}

}  // namespace grainlaw::core
