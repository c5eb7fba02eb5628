// A packing as another program has it, before the library brings it to equilibrium.
#pragma once

#include "import/source_table.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace verification {

struct ForeignContact {
  std::size_t i = 0, j = 0;
  std::array<int, 3> shift{};                      // branch x_j - x_i + H shift
  double normal = 0;                               // compression positive [N]
  Position tangential{};                           // on j [N]
  Position moment{};                               // on j [N m]
  double stiffness = 0, tangential_stiffness = 0;  // that the file has, or 0 [N/m]
  bool bonded = false;
  double bond_gap = 0;  // stress-free branch less R_i + R_j [m]
};

struct ForeignPacking {
  int dimension = 2;
  std::vector<long> id;
  std::vector<Position> centre;   // [m]
  std::vector<double> radius;     // [m]
  Lattice cell{};                 // of discs with the thickness at 33
  std::string cell_source;        // where it comes from, for a person
  std::optional<double> density;  // [kg/m3]
  std::vector<bool> at_wall;      // reaches a wall of a box that is taken as the cell; or empty
  bool has_contacts = false, has_moments = false, names_bonds = false;
  std::vector<ForeignContact> contacts;
  std::vector<std::string> read;   // what was read, for a person
  std::vector<std::string> notes;  // what was assumed or is odd

  [[nodiscard]] double thickness() const { return cell[8]; }
  [[nodiscard]] double volume() const;  // of the cell [m3]
  [[nodiscard]] Position branch(const ForeignContact& contact) const;
  [[nodiscard]] double overlap(const ForeignContact& contact) const;
  // Cauchy stress of the forces, -(1/V) sum of f on j (x) branch, tension positive [Pa].
  [[nodiscard]] Lattice stress() const;
};

// What the command line says of the files.
struct ForeignFiles {
  std::string particles, contacts,
      cell;  // files; the last two may be "", the last a text of numbers
  std::string separator, columns, contact_columns;
  int dimension = 0;     // 0: 3 where centres differ in z
  FileUnits units;       // told, of columns without one in their header
  double thickness = 0;  // of discs [m]; 0: of the cell
  double density = 0;    // [kg/m3]; 0: of the files
};

// Throws InputError: file, line, column, what was found and what was expected.
ForeignPacking read_foreign(const ForeignFiles& files);

// The parts of it.
void read_centres(const SourceTable& table, const ForeignFiles& files, ForeignPacking& packing);
void read_cell(const SourceTable& particles, const ForeignFiles& files, ForeignPacking& packing);
void read_forces(const SourceTable& particles, const ForeignFiles& files, ForeignPacking& packing);

// The stiffness that contacts of a file share.
struct FoundStiffness {
  double young = 0;  // [Pa] of kn = young 2 Ri Rj / (Ri + Rj); 0: no
  double kn = 0;     // [N/m] alike for all; 0: no
  double ratio = 0;  // kt / kn; 0: not in the files [-]
};
FoundStiffness found_stiffness(const ForeignPacking& packing);

// prefix_particles.csv, _contacts.csv where there are any, _cell.csv. Throws ComputationError.
void write_foreign(const ForeignPacking& packing, const std::string& prefix);

}  // namespace verification
