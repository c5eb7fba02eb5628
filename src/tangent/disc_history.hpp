// What the history of contacts of discs starts from, differentiated by the components of F.
#pragma once

#include "increment/increment.hpp"
#include "tangent/derivatives.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

// Turn and tangential force; moment and difference of the rotations, of laws that have moments.
template <>
struct HistoryChange<2> {
  const ByDeformation<2>* turn = nullptr;
  const ByDeformation<2>* force = nullptr;
  const ByDeformation<2>* moment = nullptr;
  const ByDeformation<2>* spin = nullptr;
};

template <>
class HistoryDerivatives<2> {
 public:
  // Keep those of the contacts that carry; place[c] is where listed contact c is among the changes.
  void carry(const Increment<2>& increment, std::span<const ContactChange<2>> changes,
             std::span<const ByDeformation<2>> moment_changes, std::span<const std::int32_t> place);
  // Those of the listed contacts, with the motion of the nodes and the change of F at the start.
  void start(const Increment<2>& increment, std::span<const ByDeformation<2>> motion,
             const DeformationChange<2>& change);
  [[nodiscard]] HistoryChange<2> of_list(bool moments) const {
    HistoryChange<2> history{turn_.data(), force_.data()};
    if (moments) {
      history.moment = moment_.data();
      history.spin = spin_.data();
    }
    return history;
  }

 private:
  // Hertz-Mindlin: the springs follow the overlap.
  void rescale(const Increment<2>& increment);

  std::vector<ByDeformation<2>> carried_force_, carried_moment_;  // per contact of the history
  std::vector<ByDeformation<2>> turn_, force_, moment_, spin_;    // per listed contact
  std::vector<ByDeformation<2>> overlap_;                         // of Hertz-Mindlin
};

}  // namespace grainlaw::core
