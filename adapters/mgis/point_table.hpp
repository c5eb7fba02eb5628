// Names for the points of a behaviour, whose host has two numbers for each among its internal state
// variables: which point it is, and how many increments it has gone through, the token of its table.
//
// The host never says that it drops a state. What can be lost is bounded:
//   - A point that has not got through its first increment is a function of F alone and is not kept.
//     The host's zeros name no point; when it comes back with a name, that increment is found again.
//   - A point further on is freed when it has been idle for long and all together take more memory
//     than the budget; the host is told if it still comes back.
// Idle for long: not asked for during four calls per state in memory. A host asks for each of its
// points once in as many calls as it has points.
#pragma once

#include "material_file.hpp"
#include "point.hpp"

#include <cstdint>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace grainlaw::adapters {

class PointTable {
 public:
  PointTable(const char* name, const char* path, const void* in_library);

  grainlaw::Table& table();

  // A name for a new point, and the time step of its first increment.
  long long create(double time_step);
  // Brings the point of these two numbers, step >= 1, into the table. F0 is the F that it starts from
  // now. Throws std::runtime_error when it is not known.
  long long find(double name, double step, const Tensor2& F0);

  std::size_t size() const;

 private:
  double first_time_step(std::uint64_t key) const;
  void free_idle();

  MaterialFile file_;
  mutable std::mutex mutex_;
  std::optional<grainlaw::Table> table_;
  std::unordered_map<std::uint64_t, std::uint64_t> last_calls_;  // of the points in the table
  std::vector<std::pair<std::uint64_t, double>> time_steps_;  // of first increments, from a name on
  std::uint64_t process_;  // tells names of this process from those of another
  std::uint64_t next_ = 1;
  std::uint64_t calls_ = 0;
  std::uint64_t last_scan_ = 0;
  double budget_;     // bytes
  double bytes_ = 0;  // of a state, committed and trial
};

}  // namespace grainlaw::adapters
