#include "material/packing_files.hpp"

#include "base/error.hpp"
#include "frame/frame.hpp"
#include "frame/frame_rows.hpp"
#include "io/csv_table.hpp"
#include "io/text_file.hpp"
#include "material/contact_lines.hpp"
#include "material/packing_file_checks.hpp"
#include "material/packing_text.hpp"
#include "packing/geometry.hpp"
#include "packing/lattice.hpp"
#include "packing/neighbours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace grainlaw::core {

namespace {

constexpr std::int64_t largest_shift = 32767;
constexpr std::int64_t largest_written_shift =
    1'000'000'000;  // before the change to the shortest basis

using Ids = ParticleIds;

enum ParticleColumn : std::size_t {
  id,
  x,
  y,
  r,
  role,
  partner,
  frame_order,
  reference_x,
  reference_y
};
enum ContactColumn : std::size_t { i, j, shift_x, shift_y, fn, ftx, fty, moment, bonded, bond_gap };
enum CellColumn : std::size_t { h00, h01, h10, h11, thickness, rho, f00, f01, f10, f11 };

using Source = PackingText;

struct CellFile {
  Basis basis;                         // basis of shifts from here on
  std::optional<Lattice> deformation;  // F of a frame
};

CellFile read_cell(const Source& source, Packing& packing) {
  constexpr double furthest_sheared = 1e6;  // larger shifts cost the digits of an overlap
  CsvTable<10> table(source.path, source.text,
                     {"H00[m]", "H01[m]", "H10[m]", "H11[m]", "thickness[m]", "rho[kg/m3]",
                      "F00[-]", "F01[-]", "F10[-]", "F11[-]"});
  table.require(h00, rho);
  if (!table.next()) table.fail("expected one line of numbers after the header");
  const Lattice h{table.real(h00), table.real(h01), table.real(h10), table.real(h11)};
  packing.cell = {h[0], h[1], h[2], h[3]};
  packing.thickness = table.positive(thickness);
  if (table.has(rho)) packing.density = table.positive(rho);
  const double area = determinant<2>(h);
  if (!(area > 0) || !std::isfinite(area))
    table.fail(fmt::format("found a cell of area {} m2, expected det H > 0", area));
  if (const double times = longest_vector(h) / longest_vector(reduced_basis(h).cell);
      !(times < furthest_sheared))
    table.fail(
        fmt::format("its vectors are {:.3g} times as long as others of the same lattice need "
                    "to be, expected at most {:g}",
                    times, furthest_sheared));
  CellFile cell{{h}, {}};
  if (table.has(f00)) {
    table.require(f00, f11 + 1);
    cell.deformation = {table.real(f00), table.real(f01), table.real(f10), table.real(f11)};
    const auto& f = *cell.deformation;
    if (const double det = determinant<2>(f); !(det > 0) || !std::isfinite(det))
      table.fail(fmt::format("found det F = {}, expected a number > 0", det));
  }
  if (table.next()) table.fail("expected one line of numbers after the header, found another");
  return cell;
}

// Replaces the basis of a lattice that has much shorter vectors, as after large shear, by the
// shortest. Other lattices keep their bits.
void shorten(CellFile& cell, Packing& packing) {
  constexpr double much_longer = 4;
  const Basis reduced = reduced_basis(cell.basis.cell);
  if (!(longest_vector(cell.basis.cell) > much_longer * longest_vector(reduced.cell))) return;
  // Fails for shifts beyond the range of their products, as in a cell far thinner than any disc.
  const auto in_range = [](std::int64_t n) { return std::abs(n) <= largest_written_shift; };
  if (!std::ranges::all_of(reduced.change, in_range)) return;
  cell.basis = reduced;
  std::ranges::copy(reduced.cell, packing.cell.begin());
}

template <class Table>
void read_frame_row(const Table& table, int particle, FrameRows& rows) {
  if (table.text(role) == "inner") return;
  const bool corner = table.text(role) == "corner";
  if (!corner && table.text(role) != "edge") table.complain(role, "inner, edge or corner");
  if (!rows.particle_at.emplace(table.integer(frame_order), particle).second)
    table.complain(frame_order, "a place that no other particle has");
  if (corner) {
    ++rows.corners;
  } else {
    rows.partner_id.emplace(particle, table.integer(partner));
  }
}

// Fails for positions beyond the cell numbers of the neighbour search, or so far from the origin
// that digits are lost.
template <class Table>
void check_position(const Table& table, const Packing& packing, double y_first, double y_last) {
  constexpr double furthest_apart = 16000, furthest = 1e8;  // [cells]
  const auto& h = packing.cell;
  const double area = determinant<2>(h.data());
  const auto cells = [&](double dx, double dy) {
    return std::max(std::abs(h[3] * dx - h[1] * dy), std::abs(h[0] * dy - h[2] * dx)) / area;
  };
  const double x_first = packing.position.front();
  const double x_last = packing.position.back();
  if (const double away = cells(x_last, y_last); !(away <= furthest))
    table.fail(fmt::format("the centre is {:.3g} cells from the origin, expected at most {:g}",
                           away, furthest));
  if (const double away = cells(x_last - x_first, y_last - y_first); !(away <= furthest_apart))
    table.fail(fmt::format("the centre is {:.3g} cells from the first, expected at most {:g}", away,
                           furthest_apart));
}

Ids read_particles(const Source& source, CellFile& cell, Packing& packing) {
  CsvTable<9> table(source.path, source.text,
                    {"id", "x[m]", "y[m]", "r[m]", "role", "partner", "frame_order",
                     "reference_x[m]", "reference_y[m]"});
  const bool framed = table.has(role) || table.has(partner) || table.has(frame_order);
  table.require(id, framed ? frame_order + 1 : role);
  const bool deformed = framed && table.has(reference_x);
  if (deformed) table.require(reference_x, reference_y + 1);
  if (deformed != (framed && cell.deformation))
    table.fail(
        "found only one of reference_x, reference_y here and F00 to F11 of the cell, expected "
        "both or none");
  if (!framed) shorten(cell, packing);
  Ids ids;
  std::vector<double> ys, reference_ys;
  FrameRows rows;
  Frame frame;
  while (table.next()) {
    const auto particle = static_cast<int>(packing.radius.size());
    if (!ids.emplace(table.integer(id), particle).second)
      table.complain(id, "an id that no other particle has");
    packing.position.push_back(table.real(x));
    ys.push_back(table.real(y));
    check_position(table, packing, ys.front(), ys.back());
    packing.radius.push_back(table.positive(r));
    if (framed) read_frame_row(table, particle, rows);
    if (!deformed) continue;
    frame.reference.push_back(table.real(reference_x));
    reference_ys.push_back(table.real(reference_y));
  }
  if (ids.empty()) table.fail("found no particle");
  packing.position.insert(packing.position.end(), ys.begin(), ys.end());
  frame.reference.insert(frame.reference.end(), reference_ys.begin(), reference_ys.end());
  if (deformed) frame.deformation = *cell.deformation;
  if (framed) build_frame(source.path, rows, ids, std::move(frame), packing);
  return ids;
}

// Reads the contacts; returns the line of each.
std::vector<unsigned> read_contacts(const Source& source, const Ids& ids, const Basis& basis,
                                    Packing& packing) {
  CsvTable<10> table(source.path, source.text,
                     {"i", "j", "shift_x[-]", "shift_y[-]", "fn[N]", "ftx_on_j[N]", "fty_on_j[N]",
                      "moment[N m]", "bonded[-]", "bond_gap[m]"});
  table.require(i, fty + 1);
  packing.names_bonds = table.has(bonded);
  const auto particle = [&](std::size_t column) { return read_particle(table, column, ids); };
  const auto in_range = [&](std::size_t column, std::int64_t value, std::int64_t largest) {
    if (value > largest || value < -largest) table.complain(column, "at most 32767 cells");
    return value;
  };
  const auto written = [&](std::size_t column) {
    const std::int64_t value = in_range(column, table.integer(column), largest_written_shift);
    if (value != 0 && packing.frame) table.complain(column, "0, since a frame has no images");
    return value;
  };
  const auto shift = [&]() -> std::array<int, 3> {
    const auto [s0, s1] = basis.shift(written(shift_x), written(shift_y));
    return {static_cast<int>(in_range(shift_x, s0, largest_shift)),
            static_cast<int>(in_range(shift_y, s1, largest_shift))};
  };
  ContactLines contacts;
  while (table.next()) {
    InitialContact contact{
        particle(i), particle(j), shift(), table.real(fn), {table.real(ftx), table.real(fty)}};
    if (table.has(moment)) contact.moment[0] = table.real(moment);
    read_bond(table, bonded, bond_gap, contact);
    contacts.add(table, contact);
  }
  return contacts.hand_to(packing);
}

// Parses a packing; contacts without a path: none.
Packing parse(const Source& particles, const Source& contacts, const Source& cell) {
  Packing packing;
  CellFile of_cell = read_cell(cell, packing);
  const Ids ids = read_particles(particles, of_cell, packing);
  std::vector<unsigned> lines;
  if (!contacts.path.empty()) lines = read_contacts(contacts, ids, of_cell.basis, packing);
  check_sizes<2>(particles.path, ids, packing);
  check_branches<2>(contacts.path, lines, packing);
  return packing;
}

}  // namespace

Packing read_plane_packing(const PackingTexts& texts) {
  return parse(texts.particles, texts.contacts, texts.cell);
}

}  // namespace grainlaw::core
