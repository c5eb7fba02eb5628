// Reports and summaries of callers compiled against this header or an earlier one.
#pragma once

#include <grainlaw/grainlaw.h>

#include <cstddef>
#include <cstring>

namespace grainlaw::core::api {

// Sizes of the fields of the first version. Later versions only append, so that a size identifies every
// version in between. A larger size belongs to a header newer than this library.
inline constexpr std::size_t first_report_size =
    offsetof(grainlaw_report, message) + sizeof(grainlaw_report::message);

inline bool known_report_size(std::size_t size) {
  return size >= first_report_size && size <= sizeof(grainlaw_report);
}

inline constexpr std::size_t first_summary_size =
    offsetof(grainlaw_summary, message) + sizeof(grainlaw_summary::message);

inline bool known_summary_size(std::size_t size) {
  return size >= first_summary_size && size <= sizeof(grainlaw_summary);
}

// Size that the caller wrote at the start of its report or summary.
inline std::size_t claimed_size(const void* report) {
  std::size_t size;
  std::memcpy(&size, report, sizeof size);
  return size;
}

// Copies as much of the full struct as the caller's struct holds; the caller's size stays.
template <class Struct>
void copy_out(const Struct& full, void* to) {
  constexpr std::size_t after_size = sizeof(full.size);
  std::memcpy(static_cast<char*>(to) + after_size,
              reinterpret_cast<const char*>(&full) + after_size, claimed_size(to) - after_size);
}

// The caller's array of reports, or none.
class Reports {
 public:
  explicit Reports(grainlaw_report* first)
      : first_(first), stride_(first == nullptr ? 0 : padded(claimed_size(first))) {}

  // Returns OK or BAD_REPORT for n reports, which need one known size.
  [[nodiscard]] grainlaw_status check(std::size_t n) const {
    if (first_ == nullptr || n == 0) return GRAINLAW_OK;
    const std::size_t size = claimed_size(first_);
    if (!known_report_size(size)) return GRAINLAW_BAD_REPORT;
    for (std::size_t k = 0; k < n; ++k)
      if (claimed_size(at(k)) != size) return GRAINLAW_BAD_REPORT;
    return GRAINLAW_OK;
  }
  [[nodiscard]] void* at(std::size_t k) const {
    return first_ == nullptr ? nullptr : reinterpret_cast<char*>(first_) + k * stride_;
  }

 private:
  static std::size_t padded(std::size_t size) {
    constexpr std::size_t alignment = alignof(grainlaw_report);
    return (size + alignment - 1) / alignment * alignment;
  }

  grainlaw_report* first_;
  std::size_t stride_;
};

}  // namespace grainlaw::core::api
