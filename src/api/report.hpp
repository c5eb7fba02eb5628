// Reports of callers built against this header or an earlier one.
#pragma once

#include <grainlaw/grainlaw.h>

#include <cstddef>
#include <cstring>

namespace grainlaw::api {

// The fields of version 0.1. Later versions only append, so a caller of any version in between is
// told by its size; a larger size belongs to a newer header than this library knows.
inline constexpr std::size_t first_report_size =
    offsetof(grainlaw_report, message) + sizeof(grainlaw_report::message);

inline bool known_report_size(std::size_t size) {
  return size >= first_report_size && size <= sizeof(grainlaw_report);
}

// The size a caller wrote at the start of its report.
inline std::size_t claimed_size(const void* report) {
  std::size_t size;
  std::memcpy(&size, report, sizeof size);
  return size;
}

// As much of the full report as the caller's struct holds; the caller's size stays.
inline void copy_report(const grainlaw_report& full, void* report) {
  constexpr std::size_t after_size = sizeof(full.size);
  std::memcpy(static_cast<char*>(report) + after_size,
              reinterpret_cast<const char*>(&full) + after_size, claimed_size(report) - after_size);
}

}  // namespace grainlaw::api
