// The periodic cell: as told, of a file of its own, of the file of the particles, or the box around them.
#include "app/library.hpp"
#include "import/foreign_packing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

namespace verification {
namespace {

constexpr const char* forms =
    "LX,LY or LX,LY,LZ; H row by row, 4 or 9 numbers; a file with columns H00, H01, ...; or box, "
    "the "
    "box around the particles";

// H of so many numbers; of discs with thickness 0 where it is not among them.
std::optional<Lattice> lattice_of(const std::vector<double>& v, int dimension) {
  if (v.size() == 2 && dimension == 2) return Lattice{v[0], 0, 0, 0, v[1], 0, 0, 0, 0};
  if (v.size() == 3) return Lattice{v[0], 0, 0, 0, v[1], 0, 0, 0, v[2]};
  if (v.size() == 4 && dimension == 2) return Lattice{v[0], v[1], 0, v[2], v[3], 0, 0, 0, 0};
  if (v.size() != 9) return std::nullopt;
  Lattice h;
  std::copy(v.begin(), v.end(), h.begin());
  return h;
}

Lattice cell_of_numbers(const std::string& text, int dimension) {
  std::vector<double> values;
  for (const std::string_view part : fields(text, ",")) {
    const auto value = number_in(part);
    if (!value)
      throw InputError(fmt::format(
          "--cell: found '{}', which is no file and no number, expected {}", part, forms));
    values.push_back(*value);
  }
  const auto h = lattice_of(values, dimension);
  if (!h)
    throw InputError(fmt::format("--cell: found {} numbers for {}, expected {}", values.size(),
                                 dimension == 3 ? "spheres" : "discs", forms));
  return *h;
}

Lattice cell_of_file(const ForeignFiles& files, ForeignPacking& packing) {
  const SourceTable table = read_source(files.cell, files.separator, files.units);
  Columns columns(table, {});
  const auto dimension = static_cast<std::size_t>(packing.dimension);
  Lattice h{};
  std::vector<std::string> needed;
  for (std::size_t i = 0; i < dimension; ++i)
    for (std::size_t j = 0; j < dimension; ++j) {
      needed.push_back(fmt::format("H{}{}", i, j));
      columns.find(needed.back(), {fmt::format("h{}{}", i, j)}, Quantity::length);
    }
  columns.find("thickness", {"thickness"}, Quantity::length);
  if (!packing.density) columns.find("rho", {"rho", "density"}, Quantity::density);
  columns.require(needed);
  if (table.rows.size() != 1)
    table.fail(table.lines[1], "found another line of numbers, expected one cell");
  for (std::size_t i = 0; i < dimension; ++i)
    for (std::size_t j = 0; j < dimension; ++j)
      h[3 * i + j] = columns.real(0, fmt::format("H{}{}", i, j));
  if (dimension == 2 && columns.has("thickness")) h[8] = columns.positive(0, "thickness");
  if (columns.has("rho")) packing.density = columns.positive(0, "rho");
  return h;
}

// The walls of a box that holds the particles, whose sides become periodic.
Lattice box_around(ForeignPacking& packing) {
  constexpr double near = 0.1;  // of a radius: more than grains overlap with a wall
  packing.at_wall.assign(packing.radius.size(), false);
  Lattice h{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(packing.dimension); ++k) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t p = 0; p < packing.radius.size(); ++p) {
      low = std::min(low, packing.centre[p][k] - packing.radius[p]);
      high = std::max(high, packing.centre[p][k] + packing.radius[p]);
    }
    h[4 * k] = high - low;
    for (std::size_t p = 0; p < packing.radius.size(); ++p) {
      const double x = packing.centre[p][k], reach = (1 + near) * packing.radius[p];
      if (x - reach < low || x + reach > high) packing.at_wall[p] = true;
    }
  }
  return h;
}

// A cell that another program writes with turned handedness would have a negative volume.
void check(const ForeignPacking& packing, const SourceTable& particles) {
  const double volume = packing.volume();
  if (!(volume > 0) || !std::isfinite(volume))
    throw InputError(fmt::format("{}: found a cell of volume {} m3 ({}), expected det H > 0",
                                 particles.path, volume, packing.cell_source));
  const double d = packing.dimension;
  double solid = 0;
  for (const double r : packing.radius) solid += d == 2 ? M_PI * r * r : 4 * M_PI / 3 * r * r * r;
  const double fraction = solid / (d == 2 ? volume / packing.thickness() : volume);
  if (fraction > 1 || fraction < 0.1)
    throw InputError(
        fmt::format("{}: found particles that fill {:.3g} of the cell ({}), expected 0.1 to 1: is "
                    "the cell theirs, "
                    "and in the same unit (--length-unit)?",
                    particles.path, fraction, packing.cell_source));
}

}  // namespace

void read_cell(const SourceTable& particles, const ForeignFiles& files, ForeignPacking& packing) {
  if (files.cell == "box") {
    packing.cell = box_around(packing);
    packing.cell_source = "the box around the particles";
  } else if (!files.cell.empty() && std::filesystem::is_regular_file(files.cell)) {
    packing.cell = cell_of_file(files, packing);
    packing.cell_source = "of " + files.cell;
  } else if (!files.cell.empty()) {
    packing.cell = cell_of_numbers(files.cell, packing.dimension);
    for (double& h : packing.cell) h *= files.units.of(Quantity::length).value();
    packing.cell_source = "as told";
  } else if (particles.cell) {
    packing.cell = *particles.cell;
    for (double& h : packing.cell) h *= particles.unit(Quantity::length);
    packing.cell_source = "of the same file";
  } else {
    particles.fail(fmt::format("found no periodic cell in it, expected --cell: {}", forms));
  }
  if (packing.dimension == 2) {
    Lattice& h = packing.cell;
    h[2] = h[5] = h[6] = h[7] = 0;
    if (files.thickness > 0) h[8] = files.thickness;
    if (!(h[8] > 0))
      throw InputError(fmt::format("{}: found discs without a thickness, expected --thickness in m",
                                   particles.path));
  }
  check(packing, particles);
  const Lattice& h = packing.cell;
  packing.read.push_back(
      packing.dimension == 2
          ? fmt::format("cell {}: H = [{:.6g}, {:.6g}; {:.6g}, {:.6g}] m, thickness {:.6g} m",
                        packing.cell_source, h[0], h[1], h[3], h[4], h[8])
          : fmt::format(
                "cell {}: H = [{:.6g}, {:.6g}, {:.6g}; {:.6g}, {:.6g}, {:.6g}; {:.6g}, {:.6g}, "
                "{:.6g}] m",
                packing.cell_source, h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8]));
}

}  // namespace verification
