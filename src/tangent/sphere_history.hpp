// Derivatives of the contact history of spheres by the components of F. @formula sensitivity
#pragma once

#include "increment/increment.hpp"
#include "tangent/derivatives.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

using TripleByDeformation = std::array<ByDeformation<3>, 3>;

// Changes of n_c, ft_c and, for laws with moments, m_c.
template <>
struct HistoryChange<3> {
  const TripleByDeformation* normal = nullptr;
  const TripleByDeformation* force = nullptr;
  const TripleByDeformation* moment = nullptr;
  const ByDeformation<3>* motion = nullptr;  // of the nodes at the start, by component
};

template <>
class HistoryDerivatives<3> {
 public:
  // Carries and starts the derivatives; see HistoryDerivatives<2>.
  void carry(const Increment<3>& increment, std::span<const ContactChange<3>> changes,
             std::span<const ByDeformation<3>> moment_changes, std::span<const std::int32_t> index);
  void start(const Increment<3>& increment, std::span<const ByDeformation<3>> motion,
             const DeformationChange<3>& change);
  [[nodiscard]] HistoryChange<3> of_list(bool moments) const {
    return {normal_.data(), force_.data(), moments ? moment_.data() : nullptr, motion_.data()};
  }

 private:
  std::vector<TripleByDeformation> carried_force_, carried_moment_;  // per contact of the history
  std::vector<TripleByDeformation> normal_, force_, moment_;         // per listed contact
  std::span<const ByDeformation<3>> motion_;
};

}  // namespace grainlaw::core
