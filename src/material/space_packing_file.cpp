// Packings of spheres on disk.
#include "base/error.hpp"
#include "io/csv_table.hpp"
#include "material/contact_lines.hpp"
#include "material/packing_file_checks.hpp"
#include "material/packing_files.hpp"
#include "math/tensor.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace grainlaw::core {

namespace {

constexpr std::int64_t largest_shift = 511;

enum ParticleColumn : std::size_t { id, x, y, z, r };
enum ContactColumn : std::size_t {
  i,
  j,
  shift_x,
  shift_y,
  shift_z,
  fn,
  ftx,
  fty,
  ftz,
  moment_x,
  moment_y,
  moment_z,
  bonded,
  bond_gap
};
enum CellColumn : std::size_t { h00, rho = 9, thickness };

void read_cell(const PackingText& source, Packing& packing) {
  CsvTable<11> table(source.path, source.text,
                     {"H00[m]", "H01[m]", "H02[m]", "H10[m]", "H11[m]", "H12[m]", "H20[m]",
                      "H21[m]", "H22[m]", "rho[kg/m3]", "thickness[m]"});
  table.require(h00, rho);
  if (table.has(thickness))
    table.fail("found a column 'thickness', expected none: spheres have their own");
  if (!table.next()) table.fail("expected one line of numbers after the header");
  for (std::size_t k = 0; k < 9; ++k) packing.cell[k] = table.real(h00 + k);
  if (table.has(rho)) packing.density = table.positive(rho);
  const double volume = determinant<3>(packing.cell.data());
  if (!(volume > 0) || !std::isfinite(volume))
    table.fail(fmt::format("found a cell of volume {} m3, expected det H > 0", volume));
  if (table.next()) table.fail("expected one line of numbers after the header, found another");
}

// Fails for positions beyond the cell numbers of the neighbour search.
template <class Table>
void check_position(const Table& table, const Tensor<3>& to_cells, const Vec<3>& first,
                    const Vec<3>& position) {
  constexpr double furthest_apart = 250, furthest = 1e8;  // [cells]
  const auto cells = [&](const Vec<3>& vector) {
    const Vec<3> counts = product<3>(to_cells, vector);
    return std::max({std::abs(counts[0]), std::abs(counts[1]), std::abs(counts[2])});
  };
  if (const double away = cells(position); !(away <= furthest))
    table.fail(fmt::format("the centre is {:.3g} cells from the origin, expected at most {:g}",
                           away, furthest));
  const Vec<3> apart{position[0] - first[0], position[1] - first[1], position[2] - first[2]};
  if (const double away = cells(apart); !(away <= furthest_apart))
    table.fail(fmt::format("the centre is {:.3g} cells from the first, expected at most {:g}", away,
                           furthest_apart));
}

ParticleIds read_particles(const PackingText& source, Packing& packing) {
  CsvTable<5> table(source.path, source.text, {"id", "x[m]", "y[m]", "z[m]", "r[m]"});
  table.require(id, r + 1);
  const Tensor<3> to_cells = inverse<3>(tensor_of<3>(packing.cell));
  ParticleIds ids;
  std::array<std::vector<double>, 3> positions;
  Vec<3> first{};
  while (table.next()) {
    const auto particle = static_cast<int>(packing.radius.size());
    if (!ids.emplace(table.integer(id), particle).second)
      table.complain(id, "an id that no other particle has");
    const Vec<3> position{table.real(x), table.real(y), table.real(z)};
    if (particle == 0) first = position;
    check_position(table, to_cells, first, position);
    for (std::size_t k = 0; k < 3; ++k) positions[k].push_back(position[k]);
    packing.radius.push_back(table.positive(r));
  }
  if (ids.empty()) table.fail("found no particle");
  for (const auto& component : positions) {
    packing.position.insert(packing.position.end(), component.begin(), component.end());
  }
  return ids;
}

// Reads the contacts; returns the line of each.
std::vector<unsigned> read_contacts(const PackingText& source, const ParticleIds& ids,
                                    Packing& packing) {
  CsvTable<14> table(source.path, source.text,
                     {"i", "j", "shift_x[-]", "shift_y[-]", "shift_z[-]", "fn[N]", "ftx_on_j[N]",
                      "fty_on_j[N]", "ftz_on_j[N]", "moment_x[N m]", "moment_y[N m]",
                      "moment_z[N m]", "bonded[-]", "bond_gap[m]"});
  table.require(i, ftz + 1);
  if (table.has(moment_x) || table.has(moment_y) || table.has(moment_z))
    table.require(moment_x, moment_z + 1);
  packing.names_bonds = table.has(bonded);
  const auto particle = [&](std::size_t column) { return read_particle(table, column, ids); };
  const auto shift = [&](std::size_t column) {
    const std::int64_t value = table.integer(column);
    if (value > largest_shift || value < -largest_shift)
      table.complain(column, "at most 511 cells");
    return static_cast<int>(value);
  };
  ContactLines contacts;
  while (table.next()) {
    InitialContact contact{particle(i),
                           particle(j),
                           {shift(shift_x), shift(shift_y), shift(shift_z)},
                           table.real(fn),
                           {table.real(ftx), table.real(fty), table.real(ftz)}};
    for (std::size_t k = 0; k < 3 && table.has(moment_x); ++k) {
      contact.moment[k] = table.real(moment_x + k);
    }
    read_bond(table, bonded, bond_gap, contact);
    contacts.add(table, contact);
  }
  return contacts.hand_to(packing);
}

}  // namespace

Packing read_space_packing(const PackingTexts& texts) {
  Packing packing;
  packing.dimension = 3;
  read_cell(texts.cell, packing);
  const ParticleIds ids = read_particles(texts.particles, packing);
  std::vector<unsigned> lines;
  if (!texts.contacts.path.empty()) lines = read_contacts(texts.contacts, ids, packing);
  check_sizes<3>(texts.particles.path, ids, packing);
  check_branches<3>(texts.contacts.path, lines, packing);
  return packing;
}

}  // namespace grainlaw::core
