// The points of a behaviour, found by the two numbers that a host keeps for each among its internal
// state variables: which point it is, and how many increments it has gone through.
//
// The host never says commit, and never that it drops a state. What can be lost is bounded:
//   - A point that has not got through its first increment is a function of F alone. A retried
//     first increment leaves such a state behind, since the host's zeros name no point; it is freed
//     when it has been idle for long or when there are many, and made again if the host does come
//     back.
//   - A point further on is freed only when it has been idle for long and all together take more
//     memory than the budget; the host is told if it still comes back.
// Idle for long: not asked for during four calls per state in memory. A host asks for each of its
// points once in as many calls as it has points.
#pragma once

#include "material_file.hpp"
#include "point.hpp"

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <utility>
#include <vector>

namespace grainlaw::adapters {

struct TablePoint : Point {
  using Point::Point;
  double name = 0;              // GrainlawPoint
  long step = 0;                // increments committed
  std::uint64_t last_call = 0;  // under the table's lock
  bool kept = false;            // went through an increment; under the table's lock
};

class PointTable {
 public:
  PointTable(const char* name, const char* path, const void* in_library);

  const grainlaw::Material& material() { return file_.material(); }

  // A new point at F = I, not yet in the table; the time step of its first increment.
  std::shared_ptr<TablePoint> create(double time_step);
  // The point of these two numbers, step >= 1. Throws std::runtime_error when it is not known.
  std::shared_ptr<TablePoint> find(double name, double step);
  // The host has got an answer from a new point.
  void add(const std::shared_ptr<TablePoint>&);
  // The point has gone through an increment.
  void keep(const std::shared_ptr<TablePoint>&);

  std::size_t size() const;

 private:
  double first_time_step(std::uint64_t key) const;
  void limit_new();
  void free_idle();

  MaterialFile file_;
  mutable std::mutex mutex_;
  std::unordered_map<std::uint64_t, std::shared_ptr<TablePoint>> points_;
  std::deque<std::uint64_t> new_;  // in the order of their making; some are kept or gone by now
  std::vector<std::pair<std::uint64_t, double>> time_steps_;  // of first increments, from a name on
  std::uint64_t process_;  // tells names of this process from those of another
  std::uint64_t next_ = 1;
  std::uint64_t calls_ = 0;
  std::uint64_t last_scan_ = 0;
  std::size_t kept_ = 0;
  double budget_;     // bytes
  double bytes_ = 0;  // of a state
};

}  // namespace grainlaw::adapters
