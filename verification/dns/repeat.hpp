// A frame packing repeated side by side: the specimen of a direct simulation.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace verification {

// Contact of two particles of a frame; forces act on j.
struct FrameContact {
  int i = 0;
  int j = 0;
  double normal_force = 0;                   // [N], compression positive
  std::array<double, 2> tangential_force{};  // [N]
  double moment = 0;                         // [N m]
  std::optional<bool> bonded;                // nothing: the law says
  double bond_gap = 0;                       // [m]
};

// A frame of boundary particles as the library writes it to files.
struct FramePacking {
  std::vector<double> x, y, radius;     // [m]
  std::vector<int> boundary;            // anticlockwise from corner 0: bottom, right, top, left
  std::array<std::size_t, 4> corner{};  // places in the boundary; the first is 0
  std::vector<FrameContact> contacts;
  std::array<double, 4> cell{};  // H, row-major: columns lead from a side to its copy [m]
  double thickness = 1;          // [m]
  double density = 1;            // of the particles [kg/m3]

  [[nodiscard]] std::size_t size() const { return radius.size(); }
};

// From prefix_particles.csv, _contacts.csv and _cell.csv. Throws InputError when these are no frame
// whose opposite sides are copies.
FramePacking read_frame(const std::string& prefix);

// Throws ComputationError when the files cannot be written.
void write_frame(const FramePacking& frame, const std::string& prefix);

// columns x rows copies, each shifted by the vectors of the cell. Copies share the particles and
// contacts of the sides between them, so that n of them have n times the contacts of the periodic
// packing that the frame was cut from, and those of two sides once more (Liu, Bosco & Suiker 2019,
// section 4.2).
FramePacking repeat(const FramePacking& frame, int columns, int rows);

}  // namespace verification
