// Displacement components that are linked by conditions, with a check for contradictions.
#pragma once

#include "fe/conditions/program.hpp"

#include <cstddef>
#include <map>
#include <vector>

namespace verification {

// A sum of programs: index of the program, factor. Empty: zero.
using Offset = std::map<std::size_t, double>;

// Union-find over numbers 0..count-1 whose members differ by offsets. The ground, number count, is
// always a root: prescribed components follow it.
class Linkage {
 public:
  // `programs` must outlive the linkage.
  Linkage(std::size_t count, const std::vector<Program>& programs);

  // Links u[follower] = u[leader] + offset. Returns false and links nothing when this contradicts
  // earlier links; repeating a link does not.
  bool link(std::size_t follower, std::size_t leader, const Offset& offset);

  struct Member {
    std::size_t root;
    Offset offset;  // u[member] = u[root] + offset
  };
  [[nodiscard]] Member find(std::size_t member) const;

 private:
  [[nodiscard]] bool vanishes(const Offset& offset) const;

  std::vector<std::size_t> parent_;
  std::vector<Offset> offset_;  // offset to the parent
  const std::vector<Program>& programs_;
};

}  // namespace verification
