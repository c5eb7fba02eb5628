// Displacement components that follow each other, and whether what is said of them contradicts.
#pragma once

#include "fe/conditions/program.hpp"

#include <cstddef>
#include <map>
#include <vector>

namespace verification {

// A sum of programs: number of the program, factor. Empty: zero.
using Offset = std::map<std::size_t, double>;

// Union-find over numbers 0..count-1 whose members differ by offsets, and the ground, number count,
// which is always a root: what is prescribed follows it.
class Linkage {
 public:
  // The programs must outlive the linkage.
  Linkage(std::size_t count, const std::vector<Program>& programs);

  // From now on u[follower] = u[leader] + offset. False, and nothing is linked, when this
  // contradicts what was said before; saying the same twice does not.
  bool link(std::size_t follower, std::size_t leader, const Offset& offset);

  struct Place {
    std::size_t root;
    Offset offset;  // u[member] = u[root] + offset
  };
  [[nodiscard]] Place find(std::size_t member) const;

 private:
  [[nodiscard]] bool vanishes(const Offset& offset) const;

  std::vector<std::size_t> parent_;
  std::vector<Offset> offset_;  // to the parent
  const std::vector<Program>& programs_;
};

}  // namespace verification
