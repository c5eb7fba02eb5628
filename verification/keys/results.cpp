// Content of the results: columns of tables, measures, statuses.
#include "app/library.hpp"
#include "app/record.hpp"
#include "fe/output/balance.hpp"
#include "keys/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace verification {
namespace {

struct ColumnText {
  std::string_view name;  // without indices of tensors
  std::string_view meaning;
};

constexpr ColumnText record_texts[] = {
    {"step", "step of the scene; 0 is the start"},
    {"axial_strain", "1 - F22, of spheres 1 - F33: shortening positive"},
    {"volumetric_strain", "det F - 1: dilation positive"},
    {"stress_ratio", "sigma22 / sigma11; of spheres axial over lateral stress"},
    {"axial_stress", "-sigma33, compression positive; of spheres alone, as the next three"},
    {"lateral_stress", "-(sigma11 + sigma22) / 2"},
    {"mean_pressure", "p = -tr sigma / 3"},
    {"deviatoric_stress", "q, axial less lateral stress: below 0 in extension"},
    {"F",
     "deformation gradient, dx_i / dX_J, found components included; of a mesh the mean over its "
     "points"},
    {"P", "first Piola-Kirchhoff stress, tension positive; theory, equation of P"},
    {"sigma", "Cauchy stress P F^T / det F, tension positive"},
    {"fabric", "(1/C) sum n n over the contacts, of spheres alone; Guo & Zhao (2014), eq. 22"},
    {"void_ratio", "volume of the voids / volume of the particles"},
    {"coordination", "2 C / N over all particles"},
    {"coordination_no_rattlers", "(2 C - N1) / (N - N0 - N1), N_k particles with k contacts"},
    {"fabric_intensity",
     "second invariant of the deviator of 4 fabric; Guo & Zhao (2014), eqs. 24 and 25"},
    {"anisotropy", "largest / smallest eigenvalue of the fabric - 1; Liu et al. (2019), eq. 38"},
    {"mean_overlap", "of touching contacts"},
    {"mean_rotation",
     "of the particles since F = I, anticlockwise positive; of spheres the size of the mean"},
    {"elastic_energy", "stored in the contacts of the RVE; of a mesh the mean over its points"},
    {"dissipated_energy", "by friction, rolling and broken bonds since F = I"},
    {"external_work", "work of P on dF over the steps"},
    {"contacts", "that touch"},
    {"sliding", "of them at the limit of friction"},
    {"status_changes", "contacts that opened, closed, stuck, slid or lost their bond in the step"},
    {"newton_iterations", "of the stress control or of the mesh, attempts that were cut included"},
    {"evaluations", "calls of the library per point"},
    {"step_cuts", "how often the step was cut"},
    {"loose_parts", "parts that ended at loose_tolerance or out of balance"},
    {"relaxation_steps", "of all evaluations of the step"},
    {"servo_corrections", "of method = \"servo\""},
    {"factorisations", "of the stiffness, tangents included"},
    {"subincrements", "most parts that the library made of an increment by itself"},
    {"history_advanced", "accepted evaluations that advanced the friction history: approximate"},
    {"broken_bonds", "since F = I"},
    {"escaped_particles", "inner particles outside the polygon of the frame"},
    {"jumps_crossed",
     "jumps of the stress that were crossed: committed out of balance, then balanced"},
    {"unbalanced",
     "with viscous_number alone: largest drag on a particle / mean contact force; of a mesh the "
     "largest of its points"},
};

constexpr ColumnText balance_texts[] = {
    {"step", "load step"},
    {"residual", "largest relative residual that a part of the step ended at"},
    {"iterations", "of all attempts"},
    {"last_iterations", "of the attempts that succeeded"},
    {"cuts", "how often the step was cut"},
    {"jumps_crossed", "as in NAME.csv"},
    {"loose_parts", "as in NAME.csv"},
    {"history_advanced", "evaluations that ended by advancing history"},
};

// Name and unit of a column: "sigma12[Pa]" -> "sigma", "Pa".
struct Column {
  std::string name, unit;
};

Column column_of(const std::string& text) {
  const auto bracket = text.find('[');
  Column column{text.substr(0, bracket), text.substr(bracket + 1, text.size() - bracket - 2)};
  const auto digit = [](char c) { return c >= '1' && c <= '3'; };
  if (column.name.size() > 2 && digit(column.name.back()))
    column.name.resize(column.name.size() - 2);
  return column;
}

std::string columns_of(std::vector<std::string> names, std::span<const ColumnText> texts) {
  std::string rows = "| column | unit | meaning |\n|---|---|---|\n";
  std::vector<std::string> known;
  for (const std::string& name : names) {
    const Column column = column_of(name);
    if (std::ranges::find(known, column.name) != known.end()) continue;
    const auto text = std::ranges::find(texts, column.name, &ColumnText::name);
    if (text == texts.end()) throw std::logic_error("the column " + name + " has no text");
    const bool tensor = column.name.size() + column.unit.size() + 2 < name.size();
    rows += fmt::format("| `{}`{} | {} | {} |\n", column.name + (tensor ? "11" : ""),
                        tensor ? ", `12`, ..." : "", column.unit, text->meaning);
    known.push_back(column.name);
  }
  for (const ColumnText& text : texts)
    if (std::ranges::find(known, text.name) == known.end())
      throw std::logic_error(fmt::format("there is no column {}", text.name));
  return rows;
}

std::string record_table() {
  std::vector<std::string> names = record_columns<2>(true);
  // Columns of spheres alone keep their place.
  for (std::size_t at = 0; const std::string& name : record_columns<3>(true)) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) names.insert(names.begin() + static_cast<std::ptrdiff_t>(at), name);
    at = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin()) + 1;
  }
  return columns_of(names, record_texts);
}

std::string measure_table() {
  std::string rows = "| measure | components | meaning, unit |\n|---|---|---|\n";
  const auto row = [&](std::string_view name, int count, std::string_view text) {
    const std::string components = count == -2   ? "4, of spheres 9"
                                   : count == -1 ? "1, of spheres 3"
                                                 : std::to_string(count);
    rows += fmt::format("| `{}` | {} | {} |\n", name, components, as_cell(text));
  };
#define GRAINLAW_X(name, value, count, text) row(#name, count, text);
  GRAINLAW_MEASURE_LIST(GRAINLAW_X)
#undef GRAINLAW_X
  return rows;
}

std::string status_table() {
  std::string rows = "| status | number | text |\n|---|---|---|\n";
#define GRAINLAW_X(name, value, text) \
  rows += fmt::format("| `{}` | {} | {} |\n", #name, value, text);
  GRAINLAW_STATUS_LIST(GRAINLAW_X)
#undef GRAINLAW_X
  return rows;
}

}  // namespace

std::string result_table(std::string_view what) {
  if (what == "columns") return record_table();
  if (what == "balance") return columns_of(balance_columns(), balance_texts);
  if (what == "measures") return measure_table();
  if (what == "statuses") return status_table();
  return "";
}

}  // namespace verification
