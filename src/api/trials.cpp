// Trials of points as bytes.
#include "api/some_points.hpp"
#include "points/serialise_trials.hpp"

#include <grainlaw/trials.h>

using namespace grainlaw::core;

grainlaw_status grainlaw_points_save_trials(const grainlaw_points* handle, size_t n,
                                            const size_t* which, int evaluated, void* bytes,
                                            size_t* offsets) {
  const bool whole = evaluated != 0;
  return api::save_each(
      handle, n, which, bytes, offsets,
      [=](const IntegrationPoint& point) { return saved_trial_size(point, whole); },
      [=](const IntegrationPoint& point, std::span<std::byte> to) {
        save_trial(point, whole, to);
      });
}

grainlaw_status grainlaw_points_load_trials(grainlaw_points* handle, size_t n, const size_t* which,
                                            const void* bytes, const size_t* offsets, char* message,
                                            size_t message_size) {
  return api::load_each(handle, n, which, bytes, offsets, {message, message_size}, load_trials);
}
