// A frame packing repeated side by side, as specimen of a direct simulation.
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
  std::optional<bool> bonded;                // absent: the law decides
  double bond_gap = 0;                       // [m]
};

// A frame of boundary particles as in the library's files.
struct FramePacking {
  std::vector<double> x, y, radius;     // [m]
  std::vector<int> boundary;            // anticlockwise from corner 0: bottom, right, top, left
  std::array<std::size_t, 4> corner{};  // places in the boundary; the first is 0
  std::vector<FrameContact> contacts;
  std::array<double, 4> cell{};  // H, row-major: columns lead from a side to its copy [m]
  double thickness = 1;          // [m]
  double density = 1;            // density of the particles [kg/m3]

  [[nodiscard]] std::size_t size() const { return radius.size(); }
};

// Reads prefix_particles.csv, _contacts.csv and _cell.csv. Throws InputError unless these are a
// frame whose opposite sides are copies.
FramePacking read_frame(const std::string& prefix);

// Writes the three files. Throws ComputationError when it cannot.
void write_frame(const FramePacking& frame, const std::string& prefix);

// Repeats a frame in columns x rows copies, shifted by the vectors of the cell. Neighbouring copies
// share the particles and contacts of the sides between them. n copies thus have n times the
// contacts of the periodic packing that was cut, and those of two sides once more. (Liu, Bosco &
// Suiker 2019, section 4.2.)
FramePacking repeat(const FramePacking& frame, int columns, int rows);

}  // namespace verification
