// Lumped masses of a mesh.
#pragma once

#include "fe/mesh/mesh.hpp"

namespace verification {

// Mass of every displacement component [kg/m], of solids [kg], from a density in mass per reference volume [kg/m3].
// The mass of an element is shared in proportion to the integrals of its squared shape functions
// (thesis eq. 4.17, liu2019_biaxial eq. 24).
Eigen::VectorXd lumped_mass(const Mesh& mesh, double density);

}  // namespace verification
