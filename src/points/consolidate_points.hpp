// Points that are led to the stress they begin with; equal ones share the work.
#pragma once

#include "points/points.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainlaw::core {

// Copies to be led, one for all points of equal states that are to have equal stresses.
struct SharedConsolidation {
  std::vector<IntegrationPoint> leaders;
  std::vector<std::size_t> first;      // point that each was copied from
  std::vector<std::size_t> leader_of;  // of each point

  // sigma[points * dim*dim] [Pa].
  SharedConsolidation(PointSpan points, const double* sigma);

  // Pointers to the leaders.
  [[nodiscard]] std::vector<IntegrationPoint*> pointers();
  // Copies of the leaders for each point.
  [[nodiscard]] std::vector<IntegrationPoint> copies() const;
};

}  // namespace grainlaw::core
