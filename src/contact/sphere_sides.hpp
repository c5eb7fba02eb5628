// What a relaxation of spheres measures; its steps go through all contacts one by one.
#pragma once

#include "contact/disc_sides.hpp"

namespace grainlaw::core {

template <>
class ContactSides<3> {
 public:
  static constexpr bool available = false;
  using Measured = ContactSides<2>::Measured;
};

}  // namespace grainlaw::core
