// Chooses the loops of a contact law.
#pragma once

#include "contact/law.hpp"

namespace grainlaw::core {

// Loops of every law, discs' or spheres'.
template <class Loops>
struct LawTable {
  const Loops &smooth, &locked, &rotating, &rolling, &bonded_locked, &bonded;
  const Loops &hertz_smooth, &hertz_locked, &hertz, &hertz_rolling;

  [[nodiscard]] const Loops& of(const ContactLaw& law) const {
    if (law.bonds()) return law.moments() ? bonded : bonded_locked;
    if (!law.tangential()) return law.hertzian() ? hertz_smooth : smooth;
    if (!law.rotating()) return law.hertzian() ? hertz_locked : locked;
    if (law.moments()) return law.hertzian() ? hertz_rolling : rolling;
    return law.hertzian() ? hertz : rotating;
  }
};

}  // namespace grainlaw::core
