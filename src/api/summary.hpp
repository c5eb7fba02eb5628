// Summaries of calls for many points, written to the caller's struct.
#pragma once

#include "api/report.hpp"
#include "points/points.hpp"

#include <grainlaw/grainlaw.h>

#include <cstring>

namespace grainlaw::core::api {

// Summary of a call that was refused before any evaluation.
inline Summary refusal(grainlaw_status status, const char* why = nullptr) {
  Summary summary;
  summary.status = status;
  summary.step_ratio = 0;
  std::strncpy(summary.message, why == nullptr ? grainlaw_status_text(status) : why,
               sizeof summary.message - 1);
  return summary;
}

inline void write(const Summary& found, int rank, grainlaw_summary* summary) {
  if (summary == nullptr) return;
  grainlaw_summary full = grainlaw_summary_default();
  full.step_ratio = found.step_ratio;
  full.failed = static_cast<long>(found.failed);
  if (found.failed > 0) full.first_failed = static_cast<long>(found.first_failed);
  std::memcpy(full.message, found.message, sizeof full.message);
  full.rank = rank;
  copy_out(full, summary);
}

}  // namespace grainlaw::core::api
