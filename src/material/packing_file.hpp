// Packings on disk: three comma-separated files with one header line each, columns found by name,
// others ignored. Lengths in m, forces in N, density in kg/m3.
//   particles  id, x, y, r                       ids are any distinct integers; order is kept
//              role, partner, frame_order        of a frame: inner|edge|corner, id of the opposite
//                                                copy or -1, place along the boundary or -1
//              reference_x, reference_y          of a frame that was written deformed: where its
//                                                boundary conditions count from, with F of the cell
//   contacts   i, j, shift_x, shift_y            branch x_j - x_i + H shift; the forces act on j
//              fn, ftx_on_j, fty_on_j
//              moment, bonded, bond_gap          when needed: on j [N m]; 0 or 1; stress-free branch
//                                                of the bond - (R_i + R_j)
//   cell       H00, H01, H10, H11, thickness     lattice vectors as columns of H; rho is optional
//              F00, F01, F10, F11                from reference_x, reference_y to x, y on average
// Spheres have z, shift_z and ftz_on_j beside, H00 to H22, and no thickness.
#pragma once

#include "packing/packing.hpp"

#include <string>

namespace grainlaw::core {

struct PackingPaths {
  std::string particles;
  std::string contacts;  // may be empty: no initial forces
  std::string cell;
};

// Contacts come out with i <= j, ordered by (i, j, shift); a cell whose lattice has much shorter
// vectors, as one sheared far, comes out in those. Throws Error: FILE_ERROR when a file
// cannot be opened, BAD_PACKING when its content is wrong (message with file, line, what was found
// and expected).
Packing read_packing(const PackingPaths& paths, int dimension = 2);

// Write prefix_particles.csv, prefix_contacts.csv and prefix_cell.csv, so that reading them gives
// the same bits. Throws Error (FILE_ERROR; BAD_PACKING where they could not be read, and writes
// nothing then).
void write_packing(const std::string& prefix, const Packing& packing);

}  // namespace grainlaw::core
