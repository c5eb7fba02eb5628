// A packing read from the library's files: prefix_particles.csv, prefix_contacts.csv,
// prefix_cell.csv.
#pragma once

#include <Eigen/Dense>

#include <string>
#include <vector>

namespace verification {

struct WrittenContact {
  std::size_t i = 0, j = 0;
  Eigen::Vector2i shift = Eigen::Vector2i::Zero();  // branch x_j - x_i + cell shift
  double normal_force = 0;                          // [N]
  double weight = 1;                                // 1 / copies of the contact in a frame [-]
};

struct WrittenPacking {
  Eigen::Matrix2d cell;                 // lattice vectors as columns [m]
  std::vector<Eigen::Vector2d> centre;  // wrapped into a periodic cell [m]
  std::vector<double> radius;           // [m]
  std::vector<WrittenContact> contacts;
  std::vector<std::size_t> boundary;  // boundary of a frame, anticlockwise; empty: periodic

  [[nodiscard]] bool periodic() const { return boundary.empty(); }
  [[nodiscard]] Eigen::Vector2d branch(const WrittenContact& contact) const {
    return centre[contact.j] - centre[contact.i] + cell * contact.shift.cast<double>();
  }
};

// Reads the three files. Throws InputError.
WrittenPacking read_written(const std::string& prefix);

}  // namespace verification
