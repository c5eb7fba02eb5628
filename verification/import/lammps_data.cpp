// Data files of LAMMPS (its manual: read_data).
#include "import/lammps_box.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace verification {
namespace {

std::vector<std::string> names_of_style(const SourceTable& table, std::size_t line,
                                        std::string_view style, std::size_t width, bool liggghts) {
  std::vector<std::string> names;
  const std::string size = liggghts ? "radius" : "diameter";
  if (style.empty() || style == "sphere" || style == "granular")
    names = {"id", "type", size, "density", "x", "y", "z"};
  else if (style == "bpm/sphere")
    names = {"id", "molecule", "type", size, "density", "x", "y", "z"};
  else
    table.fail(line,
               fmt::format("found atoms of style '{}', expected 'sphere' or 'bpm/sphere', which "
                           "have a size",
                           style));
  const std::size_t own = names.size();
  if (width == own + 3) names.insert(names.end(), {"image x", "image y", "image z"});
  if (names.size() != width)
    table.fail(line, fmt::format("found {} fields, expected {} or {}: {}", width, own, own + 3,
                                 "id type diameter density x y z, and places of the image"));
  return names;
}

// "..., timestep = 100, units = si", which LAMMPS puts in the first line.
void take_title(SourceTable& table, std::string_view title) {
  for (std::string_view part : fields(title, ",")) {
    const std::vector<std::string_view> parts = words(part);
    if (parts.size() != 3 || parts[1] != "=") continue;
    if (parts[0] == "units") take_lammps_units(table, 1, parts[2]);
    const auto step = number_in(parts[2]);
    if (parts[0] == "timestep" && step) table.step = static_cast<long>(*step);
  }
}

bool is_bonded_thing(std::string_view name) {
  constexpr std::array names{"bonds",      "angles", "dihedrals", "impropers",
                             "ellipsoids", "lines",  "triangles", "bodies"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

bool is_lammps_data(std::string_view text) {
  // "400 atoms" within the header, which begins with a line for people.
  Lines lines(text);
  lines.next();
  for (int k = 0; k < 40 && lines.next();) {
    const std::vector<std::string_view> parts = words(lines.text());
    if (parts.size() == 2 && parts[1] == "atoms" && number_in(parts[0])) return true;
    k += parts.empty() ? 0 : 1;
  }
  return false;
}

void read_lammps_data(SourceTable& table) {
  Lines lines(*table.text);
  lines.next();
  const bool liggghts = lines.text().starts_with("LIGGGHTS Description");  // as YADE writes it
  table.kind = liggghts ? "a text export of YADE, format liggghts_in" : "a data file of LAMMPS";
  table.lammps = !liggghts;
  take_title(table, lines.text());
  LammpsBox box;
  bool bounded = false;
  std::size_t atoms = 0, line_of_count = 0;
  while (lines.next()) {
    const auto hash = lines.text().find('#');
    const std::vector<std::string_view> parts = words(lines.text().substr(0, hash));
    if (parts.empty()) continue;
    const auto value = [&](std::size_t k) { return lammps_number(table, lines, parts, k); };
    const auto axis = [&](std::string_view word, char first, const char* expected) {
      const auto k = static_cast<std::size_t>(word.front() - first);
      if (k > 2) table.fail(lines.number(), fmt::format("found '{}', expected {}", word, expected));
      return k;
    };
    if (parts.size() == 2 && parts[1] == "atoms") {
      atoms = static_cast<std::size_t>(std::max(0.0, value(0)));
      line_of_count = lines.number();
    } else if (parts.size() == 4 && parts[2].ends_with("lo")) {
      const std::size_t k = axis(parts[2], 'x', "xlo, ylo or zlo");
      box.low[k] = value(0);
      box.high[k] = value(1);
      bounded = true;
    } else if (parts.size() == 2 && is_bonded_thing(parts[1])) {
      if (value(0) > 0)
        table.fail(lines.number(), fmt::format("found {} {}, expected none: only atoms are read",
                                               parts[0], parts[1]));
    } else if (parts.size() == 4 && parts[3].size() == 4 && parts[3].ends_with("vec")) {
      if (!box.vectors) box.vectors.emplace();
      (*box.vectors)[axis(parts[3], 'a', "avec, bvec or cvec")] = {value(0), value(1), value(2)};
      bounded = true;
    } else if (parts.size() == 5 && parts[3] == "abc") {
      box.low = {value(0), value(1), value(2)};
    } else if (parts.size() == 6 && parts[3] == "xy") {
      box.xy = value(0);
      box.xz = value(1);
      box.yz = value(2);
    } else if (parts[0] == "Atoms") {
      const auto hint = hash == std::string_view::npos ? std::vector<std::string_view>()
                                                       : words(lines.text().substr(hash + 1));
      const std::string_view style = hint.empty() ? std::string_view() : hint.front();
      while (table.rows.size() < atoms && lines.next()) {
        if (lines.text().empty()) continue;
        std::vector<std::string_view> one = words(lines.text().substr(0, lines.text().find('#')));
        if (table.rows.empty())
          table.names = names_of_style(table, lines.number(), style, one.size(), liggghts);
        if (one.size() != table.names.size())
          table.fail(lines.number(),
                     fmt::format("found {} fields, expected {} as in the first line of Atoms",
                                 one.size(), table.names.size()));
        table.rows.push_back(std::move(one));
        table.lines.push_back(lines.number());
      }
      break;
    }
  }
  if (table.rows.empty() || table.rows.size() < atoms)
    table.fail(line_of_count,
               fmt::format("found {} of {} atoms under Atoms", table.rows.size(), atoms));
  // YADE's bounds are those of the spheres, not of the cell.
  if (bounded && !liggghts) box.give(table, line_of_count);
}

}  // namespace verification
