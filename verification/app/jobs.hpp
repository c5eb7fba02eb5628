// Independent jobs on threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace verification {

// Calls job(0), ..., job(count - 1) in `threads` threads (>= 1), or in fewer where some cannot
// start. All jobs are run before the error of the first failed one is thrown.
template <class Job>
void run_jobs(std::size_t count, int threads, Job&& job) {
  std::vector<std::exception_ptr> errors(count);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < count; k = next++) {
      try {
        job(k);
      } catch (...) {
        errors[k] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> others;
    try {
      for (std::size_t k = 1; k < std::min(count, static_cast<std::size_t>(threads)); ++k)
        others.emplace_back(work);
    } catch (const std::system_error&) {  // no more threads: the others do all jobs
    }
    work();
  }
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace verification
