// Thirty-two spheres: tenths of a millisecond a point and step.
#pragma once

#include "../temporary_directory.hpp"

#include <fstream>
#include <random>
#include <string>

namespace verification {

// Two by two by two face-centred cells that overlap by half a per cent; radii are spread a little, so
// that spheres turn and slide. Written to `directory` as particles.csv and cell.csv.
inline void write_sphere_lattice(const grainlaw::test::TemporaryDirectory& directory) {
  constexpr double radius = 5e-3, side = 0.995 * 2.0 * 1.4142135623730951 * radius;  // [m]
  constexpr double corners[4][3] = {{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> spread(0.998, 1.002);
  std::ofstream particles(directory / "particles.csv");
  particles.precision(17);
  particles << "id,x,y,z,r\n";
  int id = 0;
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      for (int c = 0; c < 2; ++c)
        for (const auto& corner : corners)
          particles << id++ << ',' << side * (a + corner[0]) << ',' << side * (b + corner[1]) << ','
                    << side * (c + corner[2]) << ',' << radius * spread(random) << '\n';
  std::ofstream cell(directory / "cell.csv");
  cell.precision(17);
  cell << "H00,H01,H02,H10,H11,H12,H20,H21,H22\n"
       << 2 * side << ",0,0,0," << 2 * side << ",0,0,0," << 2 * side << '\n';
}

// The material of a scene in that directory.
inline const std::string sphere_lattice = R"(
[material]
dimension = 3
packing = { particles = "particles.csv", cell = "cell.csv" }
contact = { law = "frictional", young = 1e8, ratio = 0.8, friction = 0.5 }
)";

}  // namespace verification
