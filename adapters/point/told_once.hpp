// Errors printed as an analysis prints its own, each text once.
#pragma once

#include <cstddef>
#include <cstdio>
#include <mutex>
#include <set>
#include <string>

namespace grainlaw::adapters {

class ToldOnce {
 public:
  // Prints a text that has not been told yet.
  void tell(const char* material, const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (told_.size() == most_told || !told_.insert(text).second) return;
    std::printf("\n *ERROR in grainlaw, material %s: %s\n\n", material, text.c_str());
    if (told_.size() == most_told) {
      std::printf(" *ERROR in grainlaw, material %s: no more errors are printed\n\n", material);
    }
    std::fflush(stdout);
  }

 private:
  static constexpr std::size_t most_told = 1000;

  std::mutex mutex_;
  std::set<std::string> told_;
};

}  // namespace grainlaw::adapters
