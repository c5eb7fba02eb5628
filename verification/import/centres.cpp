// Centres and radii, and whether they are discs or spheres.
#include "app/library.hpp"
#include "import/foreign_packing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_set>

namespace verification {
namespace {

constexpr double same = 1e-9;  // of a radius: heights that count as one

bool is_flat(const std::vector<Position>& centres, double radius) {
  const auto [low, high] =
      std::minmax_element(centres.begin(), centres.end(),
                          [](const Position& a, const Position& b) { return a[2] < b[2]; });
  return (*high)[2] - (*low)[2] <= same * radius;
}

// Without names: x y r, x y z r, or id x y z r of whole numbers first.
std::array<std::size_t, 4> usual_columns(std::size_t width) {
  if (width == 3) return {1, 2, 0, 3};
  if (width == 4) return {1, 2, 3, 4};
  return {};
}

// LAMMPS: x, unwrapped xu, scaled xs or xsu.
bool find_axis(Columns& columns, const std::string& axis, std::size_t index) {
  columns.find(axis,
               {axis, "pos_" + axis, "p" + axis, axis + "u", "position_" + axis, "c" + axis,
                axis + "_pos", axis + "pos", "coord_" + axis},
               Quantity::length, index);
  if (columns.has(axis)) return false;
  columns.find(axis, {axis + "s", axis + "su"});
  return columns.has(axis);
}

// Particles that are one body.
void refuse_clumps(const SourceTable& table, const Columns& columns, ForeignPacking& packing) {
  const auto shared = [&](const std::string& name) -> std::optional<std::size_t> {
    std::unordered_set<long> seen;
    for (std::size_t p = 0; columns.has(name) && p < table.rows.size(); ++p)
      if (const long body = columns.integer(p, name);
          body >= (name == "clump" ? 0 : 1) && !seen.insert(body).second)
        return p;
    return std::nullopt;
  };
  if (const auto p = shared("clump"))
    table.fail(table.lines[*p],
               fmt::format("found another particle of clump {}, expected particles that are alone: "
                           "clumps are not read",
                           columns.integer(*p, "clump")));
  if (shared("mol"))
    packing.notes.emplace_back(
        "particles share molecules, whose bonds or rigid bodies are not read");
}

}  // namespace

void read_centres(const SourceTable& table, const ForeignFiles& files, ForeignPacking& packing) {
  const std::size_t width = table.rows.front().size();
  const auto columns_of = usual_columns(width);
  Columns columns(table, read_choice("--columns", files.columns));
  columns.find("id", {"id", "atom-id", "b.id", "number"});
  const bool scaled = find_axis(columns, "x", columns_of[0]);
  find_axis(columns, "y", columns_of[1]);
  find_axis(columns, "z", columns_of[2]);
  columns.find("r", {"r", "radius", "rad"}, Quantity::length, columns_of[3]);
  if (!columns.has("r")) columns.find("d", {"d", "diameter", "diam"}, Quantity::length);
  if (!(files.density > 0)) columns.find("density", {"density", "rho"}, Quantity::density);
  columns.find("clump", {"clump", "clumpid", "clump_id"});
  columns.find("mol", {"mol", "molecule"});
  columns.require({"x", "y"});
  if (!columns.has("d")) columns.require({"r"});
  columns.close("--columns");
  if (scaled && !table.cell)
    table.fail(table.lines.front(),
               "found centres as shares of a box and no box, expected ITEM: BOX BOUNDS");

  refuse_clumps(table, columns, packing);
  std::unordered_set<long> ids;
  bool one_density = columns.has("density");
  for (std::size_t p = 0; p < table.rows.size(); ++p) {
    const long id = columns.has("id") ? columns.integer(p, "id") : static_cast<long>(p);
    if (!ids.insert(id).second)
      table.fail(table.lines[p],
                 fmt::format("found id {} again, expected one that no other particle has", id));
    Position centre{columns.real(p, "x"), columns.real(p, "y"),
                    columns.has("z") ? columns.real(p, "z") : 0};
    if (scaled) {
      const Position s = centre;
      for (std::size_t k = 0; k < 3; ++k) {
        centre[k] = table.origin[k];
        for (std::size_t m = 0; m < 3; ++m) centre[k] += (*table.cell)[3 * k + m] * s[m];
        centre[k] *= table.unit(Quantity::length);
      }
    }
    packing.id.push_back(id);
    packing.centre.push_back(centre);
    packing.radius.push_back(columns.has("d") ? 0.5 * columns.positive(p, "d")
                                              : columns.positive(p, "r"));
    if (one_density) {
      const double density = columns.positive(p, "density");
      one_density = p == 0 || density == packing.density;
      packing.density = one_density ? std::optional(density) : std::nullopt;
    }
  }
  if (files.density > 0) packing.density = files.density;

  const double largest = *std::max_element(packing.radius.begin(), packing.radius.end());
  const bool flat = !columns.has("z") || is_flat(packing.centre, largest);
  packing.dimension = files.dimension > 0 ? files.dimension : flat ? 2 : 3;
  if (packing.dimension == 2 && !flat)
    table.fail("found centres at different heights z, expected one height with --dimension 2");
  if (packing.dimension == 3 && !columns.has("z")) columns.require({"z"});
  if (packing.dimension == 2)
    for (Position& centre : packing.centre) centre[2] = 0;
  packing.read.push_back(fmt::format("{} {} from {}, {}: {}", packing.radius.size(),
                                     packing.dimension == 3 ? "spheres" : "discs", table.path,
                                     table.kind, columns.text()));
}

}  // namespace verification
