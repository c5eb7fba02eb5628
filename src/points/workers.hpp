// Threads that share the work of a call.
#pragma once

#include <functional>

namespace grainlaw::core {

inline constexpr int most_threads = 1024;

// OMP_NUM_THREADS where it is set, else the number of processors available to this process.
int default_threads();

// Calls work() here and in up to `helpers` other threads; returns when all calls have returned.
// Each call takes items until none is left; work() does not throw. Threads and their memory persist
// for the next call; a child of fork starts its own. Where threads cannot be started, the others or
// the caller alone do all work.
void work_together(const std::function<void()>& work, int helpers) noexcept;

}  // namespace grainlaw::core
