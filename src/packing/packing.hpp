// Particles and cell of one representative volume.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace grainlaw::core {

// Initial force of a contact given with a packing. Branch l = x_j - x_i + H shift; forces act on j
// [N].
struct InitialContact {
  int i = 0;
  int j = 0;
  std::array<int, 3> shift{};
  double normal_force = 0;
  std::array<double, 3> tangential_force{};
  // Moment on j of rolling, twisting, bending or torsion; discs use the first component [N m].
  std::array<double, 3> moment{};
  bool bonded = false;  // counts where the packing names its bonds
  double bond_gap = 0;  // stress-free branch of the bond - (R_i + R_j) [m]
};

// A frame cut out along chains of particles (Liu, Bosco & Suiker 2017, section 2.1). The boundary
// runs anticlockwise from corner 0 over the sides bottom, right, top, left. Opposite sides are
// exact copies or unrelated.
struct Frame {
  std::array<bool, 2> copies{true, true};   // left with right, bottom with top
  std::vector<int> boundary;                // particles on the frame, anticlockwise, each once
  std::array<int, 4> corner{};              // anticlockwise; images of each other where sides are
                                            // copies
  std::vector<int> partner;                 // [boundary.size()] opposite copy; -1 for corners
  std::vector<std::array<double, 2>> area;  // A_q of eq. 2 per boundary particle [m], per unit t
  // Reference of a packing that was written deformed. Boundary conditions, fluctuations relative to
  // F X, copies and A_q refer to X.
  std::vector<double> reference;                  // X, laid out as `position`; empty: the positions
                                                  // [m]
  std::array<double, 4> deformation{1, 0, 0, 1};  // F from X to the positions, det F > 0
  // Per particle: source is its identity in the periodic packing, numbered by first appearance.
  // offset counts the lattice vectors, 0 or 1 each, from the first copy of that particle to this
  // one. extent is the offset of its last copy, so that copies fill the lattice points 0..extent.
  std::vector<int> source;
  std::vector<std::array<int, 2>> offset;
  std::vector<std::array<int, 2>> extent;
};

struct Packing {
  int dimension = 2;
  double thickness = 1;          // out of plane, 2D only [m]
  double density = 2650;         // density of the grains [kg/m3]; counts with solver.inertia, and
                                 // in the reference methods
  std::array<double, 9> cell{};  // H, dim x dim row-major: columns are the lattice vectors [m]
  std::vector<double> position;  // component-major: position[c * size + p] [m], not wrapped
  std::vector<double> radius;    // [m]
  std::vector<InitialContact> contacts;
  bool names_bonds = false;         // false: a law with bonds bonds every touching pair
  std::vector<std::int32_t> order;  // from row_order(); empty: as numbered
  std::optional<Frame> frame;       // present: no images, and `cell` is the frame's lattice

  [[nodiscard]] std::size_t size() const { return radius.size(); }
};

}  // namespace grainlaw::core
