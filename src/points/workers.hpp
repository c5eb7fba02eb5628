// Threads that share in the work of a call.
#pragma once

#include <functional>

namespace grainlaw::core {

inline constexpr int most_threads = 1024;

// OMP_NUM_THREADS where it is set, else as many as there are processors for this process.
int default_threads();

// Calls work() here and in up to `helpers` other threads at once, each of which takes its share until
// nothing is left; returns when all of them have. work() does not throw. The threads stay for the
// next call, with their memory; a child of fork has its own. Where some cannot be started the others,
// or the caller alone, do it all.
void work_together(const std::function<void()>& work, int helpers) noexcept;

}  // namespace grainlaw::core
