// Particles and cell of one representative volume, as read, generated or cut.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace grainlaw::core {

// A contact force that comes with a packing, so that it starts from its own equilibrium.
// Branch l = x_j - x_i + H shift; the forces act on j. [N]
struct InitialContact {
  int i = 0;
  int j = 0;
  std::array<int, 3> shift{};
  double normal_force = 0;
  std::array<double, 3> tangential_force{};
  // Of rolling, twisting, bending or torsion, on j; of discs the first alone [N m].
  std::array<double, 3> moment{};
  bool bonded = false;  // where the packing names its bonds
  double bond_gap = 0;  // stress-free branch of the bond - (R_i + R_j) [m]
};

// A packing cut out along chains of particles (Liu, Bosco & Suiker 2017, section 2.1). The boundary
// runs anticlockwise from corner 0 over the four sides: bottom, right, top, left. Opposite sides are
// exact copies, or have nothing to do with each other.
struct Frame {
  std::array<bool, 2> copies{true, true};   // left and right, bottom and top
  std::vector<int> boundary;                // particles on the frame, anticlockwise, each once
  std::array<int, 4> corner{};              // anticlockwise; of copies, images of each other
  std::vector<int> partner;                 // [boundary.size()] opposite copy; -1 for corners
  std::vector<std::array<double, 2>> area;  // A_q of eq. 2 per boundary particle [m], per unit t
  // Of a packing that was written deformed: where its boundary conditions count from. Fluctuations
  // are relative to F X, copies are copies in X, and A_q is that of X, carried along.
  std::vector<double> reference;                  // X as `position`; empty: the positions [m]
  std::array<double, 4> deformation{1, 0, 0, 1};  // F from X to here, det F > 0
  // Per particle: which particle of the periodic packing it is, numbered in order of appearance;
  // how many lattice vectors lie between that one's first copy and this one, 0 or 1 each; the same
  // for its last copy, so that the copies of a particle fill the lattice points 0..extent.
  std::vector<int> source;
  std::vector<std::array<int, 2>> offset;
  std::vector<std::array<int, 2>> extent;
};

struct Packing {
  int dimension = 2;
  double thickness = 1;          // out of plane, 2D only [m]
  double density = 2650;         // of the grains [kg/m3]; only the reference methods use it
  std::array<double, 9> cell{};  // H, dim x dim row-major: columns are the lattice vectors [m]
  std::vector<double> position;  // component-major: position[c * size + p] [m], not wrapped
  std::vector<double> radius;    // [m]
  std::vector<InitialContact> contacts;
  bool names_bonds = false;         // else a law with bonds bonds what touches
  std::vector<std::int32_t> order;  // row_order(); empty: as numbered
  std::optional<Frame> frame;       // when set, there are no images and `cell` is the frame's

  [[nodiscard]] std::size_t size() const { return radius.size(); }
};

}  // namespace grainlaw::core
