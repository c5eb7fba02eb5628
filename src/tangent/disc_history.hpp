// Derivatives of the contact history of discs by the components of F. @formula sensitivity
#pragma once

#include "increment/increment.hpp"
#include "tangent/derivatives.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

// Changes of rotation and tangential force; for laws with moments, of the moment and of theta_j -
// theta_i.
template <>
struct HistoryChange<2> {
  const ByDeformation<2>* rotation = nullptr;
  const ByDeformation<2>* force = nullptr;
  const ByDeformation<2>* moment = nullptr;
  const ByDeformation<2>* spin = nullptr;
};

template <>
class HistoryDerivatives<2> {
 public:
  // Carries the derivatives of load-bearing contacts. place[c] is the index of listed contact c
  // among the changes.
  void carry(const Increment<2>& increment, std::span<const ContactChange<2>> changes,
             std::span<const ByDeformation<2>> moment_changes, std::span<const std::int32_t> index);
  // Starts the derivatives of the listed contacts, with the motion of the nodes and the change of F
  // at the start.
  void start(const Increment<2>& increment, std::span<const ByDeformation<2>> motion,
             const DeformationChange<2>& change);
  [[nodiscard]] HistoryChange<2> of_list(bool moments) const {
    HistoryChange<2> history{rotation_.data(), force_.data()};
    if (moments) {
      history.moment = moment_.data();
      history.spin = spin_.data();
    }
    return history;
  }

 private:
  // Rescales the springs of Hertz-Mindlin contacts, which depend on the overlap.
  void rescale(const Increment<2>& increment);

  std::vector<ByDeformation<2>> carried_force_, carried_moment_;    // per contact of the history
  std::vector<ByDeformation<2>> rotation_, force_, moment_, spin_;  // per listed contact
  std::vector<ByDeformation<2>> overlap_;                           // for Hertz-Mindlin
};

}  // namespace grainlaw::core
