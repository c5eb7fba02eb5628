// Dumps and data files of LAMMPS (its manual: dump, read_data, Howto_triclinic).
#include "import/source_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace verification {
namespace {

double number(const SourceTable& table, const Lines& lines,
              const std::vector<std::string_view>& parts, std::size_t k) {
  const auto value = k < parts.size() ? number_in(parts[k]) : std::nullopt;
  if (!value)
    table.fail(lines.number(),
               fmt::format("column {}: found {}, expected a number", k + 1,
                           k < parts.size() ? fmt::format("'{}'", parts[k]) : "nothing"));
  return *value;
}

struct Box {
  Place low{}, high{};
  double xy = 0, xz = 0, yz = 0;

  void give(SourceTable& table, std::size_t line) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (!(high[k] > low[k]))
        table.fail(line,
                   fmt::format("found a box from {:g} to {:g} in direction {}, expected an upper "
                               "bound above the lower one",
                               low[k], high[k], "xyz"[k]));
    table.origin = low;
    table.cell = Lattice{high[0] - low[0], xy, xz, 0, high[1] - low[1], yz, 0, 0, high[2] - low[2]};
  }
};

// From the bounds of the box around a tilted one.
Box from_bounds(Box box) {
  box.low[0] -= std::min({0.0, box.xy, box.xz, box.xy + box.xz});
  box.high[0] -= std::max({0.0, box.xy, box.xz, box.xy + box.xz});
  box.low[1] -= std::min(0.0, box.yz);
  box.high[1] -= std::max(0.0, box.yz);
  return box;
}

// One timestep of a dump.
class Frame {
 public:
  Frame(SourceTable& table, Lines& lines) : table_(table), lines_(lines) {}

  void item(std::string_view line) {
    const std::vector<std::string_view> parts = words(line);
    const std::string_view what = parts.size() > 1 ? parts[1] : "";
    if (what == "TIMESTEP") {
      step();
      table_.kind = fmt::format("a dump of LAMMPS, step {}", lines_.text());
    } else if (what == "NUMBER") {
      step();
      count_ =
          static_cast<std::size_t>(std::max(0.0, number(table_, lines_, words(lines_.text()), 0)));
    } else if (what == "BOX") {
      box(parts);
    } else if (what == "ATOMS" || what == "ENTRIES") {
      rows(parts);
    }
  }

 private:
  void step() {
    if (!lines_.next())
      table_.fail(lines_.number(), "the dump ends here, expected more of its last step");
  }

  void box(const std::vector<std::string_view>& parts) {
    const bool tilted = parts.size() > 3 && parts[3] == "xy";
    Box box;
    const std::size_t line = lines_.number();
    for (std::size_t k = 0; k < 3; ++k) {
      step();
      const std::vector<std::string_view> values = words(lines_.text());
      box.low[k] = number(table_, lines_, values, 0);
      box.high[k] = number(table_, lines_, values, 1);
      if (tilted) (k == 0 ? box.xy : k == 1 ? box.xz : box.yz) = number(table_, lines_, values, 2);
    }
    (tilted ? from_bounds(box) : box).give(table_, line);
    table_.notes.clear();
    for (std::size_t k = 3; k < parts.size(); ++k)
      if (parts[k].find_first_of("fsm") != std::string_view::npos && parts[k].size() == 2)
        table_.notes.push_back(
            fmt::format("direction {} of the box is not periodic in LAMMPS ({}); here the cell is",
                        "xyz"[std::min<std::size_t>(2, k - (parts.size() - 3))], parts[k]));
  }

  void rows(const std::vector<std::string_view>& parts) {
    table_.names.clear();
    table_.rows.clear();
    table_.lines.clear();
    for (std::size_t k = 2; k < parts.size(); ++k) table_.names.push_back(plain_name(parts[k]));
    for (std::size_t n = 0; n < count_; ++n) {
      step();
      std::vector<std::string_view> one = words(lines_.text());
      if (one.size() != table_.names.size())
        table_.fail(lines_.number(),
                    fmt::format("found {} fields, expected {} as in the line ITEM: {}", one.size(),
                                table_.names.size(), parts[1]));
      table_.rows.push_back(std::move(one));
      table_.lines.push_back(lines_.number());
    }
  }

  SourceTable& table_;
  Lines& lines_;
  std::size_t count_ = 0;
};

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

}  // namespace

bool is_lammps_dump(std::string_view text) { return text.starts_with("ITEM:"); }

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

void read_lammps_dump(SourceTable& table) {
  Lines lines(*table.text);
  Frame frame(table, lines);
  int steps = 0;
  while (lines.next()) {
    if (!lines.text().starts_with("ITEM:"))
      table.fail(lines.number(), fmt::format("found '{}', expected a line ITEM:", lines.text()));
    steps += lines.text().starts_with("ITEM: TIMESTEP") ? 1 : 0;
    frame.item(lines.text());
  }
  if (table.rows.empty())
    table.fail("found no line of numbers in its last step, expected ITEM: ATOMS");
  if (steps > 1) table.notes.push_back(fmt::format("the last of {} steps in the file", steps));
}

void read_lammps_data(SourceTable& table) {
  Lines lines(*table.text);
  lines.next();
  const bool liggghts = lines.text().starts_with("LIGGGHTS Description");  // as YADE writes it
  table.kind = liggghts ? "a text export of YADE, format liggghts_in" : "a data file of LAMMPS";
  Box box;
  bool bounded = false;
  std::size_t atoms = 0, line_of_count = 0;
  while (lines.next()) {
    const auto hash = lines.text().find('#');
    const std::vector<std::string_view> parts = words(lines.text().substr(0, hash));
    if (parts.empty()) continue;
    const auto value = [&](std::size_t k) { return number(table, lines, parts, k); };
    if (parts.size() == 2 && parts[1] == "atoms") {
      atoms = static_cast<std::size_t>(std::max(0.0, value(0)));
      line_of_count = lines.number();
    } else if (parts.size() == 4 && parts[2].ends_with("lo")) {
      const std::size_t k = static_cast<std::size_t>(parts[2][0] - 'x');
      if (k > 2)
        table.fail(lines.number(), fmt::format("found '{}', expected xlo, ylo or zlo", parts[2]));
      box.low[k] = value(0);
      box.high[k] = value(1);
      bounded = true;
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
