// What drag changes along a path: the same path in equilibrium beside it.
#pragma once

#include "app/csv.hpp"
#include "point/scene.hpp"

#include <string>

namespace verification {

// The scene as NAME_equilibrium, its material without the law in time.
PointScene in_equilibrium(const PointScene& scene);

// Text of how stress deviator and volumetric strain differ between two tables of a path, with drag
// and in equilibrium.
std::string price_of_drag(const CsvTable& with_drag, const CsvTable& equilibrium);

}  // namespace verification
