#include "fe/conditions/linkage.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace verification {
namespace {

// Differences of programs beyond round-off.
constexpr double round_off = 1e-12;

void add(Offset& sum, const Offset& offset, double factor) {
  for (const auto& [program, value] : offset) {
    const double total = sum[program] += factor * value;
    if (total == 0) sum.erase(program);
  }
}

// Times between which a program is smooth, and further ones in a sine and after its end.
std::vector<double> sample_times(const Program& program) {
  std::vector<double> times;
  for (const auto& point : program.points) times.push_back(point[0]);
  if (program.sine.amplitude != 0)
    for (int k = 1; k < 8; ++k) times.push_back(program.sine.start + program.sine.period * k / 7);
  if (program.sine.amplitude != 0 && std::isfinite(program.sine.periods))
    times.push_back(program.sine.start + program.sine.period * (program.sine.periods + 0.3));
  return times;
}

}  // namespace

Linkage::Linkage(std::size_t count, const std::vector<Program>& programs)
    : parent_(count + 1), offset_(count + 1), programs_(programs) {
  std::iota(parent_.begin(), parent_.end(), std::size_t{0});
}

Linkage::Member Linkage::find(std::size_t member) const {
  Member found{member, {}};
  while (parent_[found.root] != found.root) {
    add(found.offset, offset_[found.root], 1);
    found.root = parent_[found.root];
  }
  return found;
}

bool Linkage::link(std::size_t follower, std::size_t leader, const Offset& offset) {
  const Member from = find(follower);
  const Member to = find(leader);
  // u[from.root] + from.offset = u[to.root] + to.offset + offset.
  Offset difference = to.offset;
  add(difference, offset, 1);
  add(difference, from.offset, -1);
  if (from.root == to.root) return vanishes(difference);
  if (from.root + 1 == parent_.size()) {  // the ground stays a root
    parent_[to.root] = from.root;
    add(offset_[to.root], difference, -1);
  } else {
    parent_[from.root] = to.root;
    offset_[from.root] = difference;
  }
  return true;
}

bool Linkage::vanishes(const Offset& offset) const {
  std::vector<double> times;
  for (const auto& entry : offset) {
    if (programs_[entry.first].steered != nullptr) return false;  // its values are not known yet
    const std::vector<double> more = sample_times(programs_[entry.first]);
    times.insert(times.end(), more.begin(), more.end());
  }
  return std::all_of(times.begin(), times.end(), [&](double time) {
    double sum = 0;
    double size = 0;
    for (const auto& [program, factor] : offset) {
      const double value = factor * programs_[program].at(time);
      sum += value;
      size += std::abs(value);
    }
    return std::abs(sum) <= round_off * size;
  });
}

}  // namespace verification
