// Packings on disk: three comma-separated files with one header line each, columns found by name,
// others ignored. Lengths in m, forces in N, density in kg/m3.
//   particles  id, x, y, r                 ids are distinct integers; order is kept
//              role, partner, frame_order  of a frame: inner|edge|corner, id of the opposite copy
//                                          or -1, place along the boundary or -1
//              reference_x, reference_y    of a frame written deformed: reference of its boundary
//                                          conditions, with F of the cell;
//   contacts   i, j, shift_x, shift_y      branch x_j - x_i + H shift; forces act on j
//              fn, ftx_on_j, fty_on_j
//              moment, bonded, bond_gap    when needed: on j [N m]; 0 or 1; stress-free branch
//                                          of the bond - (R_i + R_j);
//   cell       H00, H01, H10, H11          lattice vectors as columns of H
//              thickness, rho              rho is optional;
//              F00, F01, F10, F11          mean deformation from reference_x, reference_y to x, y.
// Spheres add z, shift_z, ftz_on_j and H00 to H22, and have no thickness.
#pragma once

#include "packing/packing.hpp"

#include <string>

namespace grainlaw::core {

struct PackingPaths {
  std::string particles;
  std::string contacts;  // may be empty: no initial forces
  std::string cell;
};

// Reads a packing. Contacts have i <= j and are ordered by (i, j, shift). A lattice with much
// shorter vectors, as after large shear, is returned in those. Throws Error: FILE_ERROR when a file
// cannot be opened, BAD_PACKING for wrong content (message with file, line, found and expected).
Packing read_packing(const PackingPaths& paths, int dimension = 2);

// Writes prefix_particles.csv, prefix_contacts.csv and prefix_cell.csv, which read back to the same
// bits. Throws Error (FILE_ERROR; BAD_PACKING for a packing that could not be read back, before
// anything is written).
void write_packing(const std::string& prefix, const Packing& packing);

}  // namespace grainlaw::core
