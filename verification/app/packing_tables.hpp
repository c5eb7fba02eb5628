// Tables of a packing, as the library writes them.
#pragma once

#include "app/csv.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace verification {

struct PackingTables {
  CsvTable particles, contacts, cell;
  std::map<double, std::size_t> number;                    // index of the particle of an id
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  // particles of each contact
  std::vector<std::size_t> boundary;  // particles of a frame in order; else empty
  std::vector<double> h;              // H, row-major: lattice vectors as columns [m]

  [[nodiscard]] bool framed() const { return particles.has("frame_order"); }
};

// Reads prefix_particles.csv, prefix_contacts.csv and prefix_cell.csv. Throws InputError.
PackingTables read_packing_tables(const std::string& prefix);

}  // namespace verification
