// Packings of a few discs whose stress is known: lattices of equal discs, and columns.
#pragma once

#include "evidence/studies/stability/packings.hpp"
#include "evidence/studies/stability/walk.hpp"

#include <Eigen/Dense>

#include <vector>

namespace verification::stability {

// A triangular lattice of discs of 5 mm radius with centres `distance` apart; it deforms affinely,
// and every disc turns alike. 2 or 3 discs per cell.
TinyPacking lattice(int discs, double distance);

// A column of discs with these radii along y, at the normal force `force` [N], far from its images.
TinyPacking column(const std::vector<double>& radii, double young, double force);

// P [Pa] at every point of a walk, with the friction history advanced from point to point by return
// mapping: exact where each increment was taken in one part.
std::vector<Tensor> lattice_stress(const std::vector<Point>& points, double distance,
                                   const Contact& contact);

// P [Pa] of a column under F without shear: its contacts are springs in series.
Tensor column_stress(const Tensor& deformation, const TinyPacking& packing, double young);

}  // namespace verification::stability
