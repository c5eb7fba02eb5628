// Particles and force chains for ParaView.
#pragma once

#include <array>
#include <span>
#include <string>

namespace grainlaw::core {

// A contact drawn as a line from the centre of particle i along the branch, to the touched image of
// j.
struct VtkContact {
  int i = 0;
  int j = 0;
  std::array<double, 3> branch{};  // [m], third component 0 in 2D
  double normal_force = 0;         // [N]
  double tangential_force = 0;     // [N]
  double moment = 0;               // moment of rolling or bending [N m]
  bool bonded = false;
};

// Writes one VTK XML PolyData file (.vtp, ascii). Vertices are particles with point data radius
// [m], rotation [rad] and coordination [-]. Lines are contacts with cell data normal_force and
// tangential_force [N], moment [N m] and bonded (0 or 1). The far end of a line is an extra point
// of radius 0; vertices carry no force.
//   position  component-major, 2 or 3 components x radius.size() [m]
//   rotation  [radius.size()], in space three times as many, component-major; empty: none [rad]
// Throws Error (FILE_ERROR).
void write_vtk(const std::string& path, std::span<const double> position,
               std::span<const double> radius, std::span<const double> rotation,
               std::span<const VtkContact> contacts);

}  // namespace grainlaw::core
