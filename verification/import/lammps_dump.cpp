// Dumps of LAMMPS, of atoms and of pairs (its manual: dump).
#include "import/lammps_box.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace verification {
namespace {

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
      table_.step = static_cast<long>(lammps_number(table_, lines_, words(lines_.text()), 0));
    } else if (what == "UNITS") {
      step();
      take_lammps_units(table_, lines_.number(), lines_.text());
    } else if (what == "TIME") {
      step();
    } else if (what == "NUMBER") {
      step();
      count_ = static_cast<std::size_t>(
          std::max(0.0, lammps_number(table_, lines_, words(lines_.text()), 0)));
    } else if (what == "BOX") {
      box(parts);
    } else if (what == "ATOMS" || what == "ENTRIES") {
      rows(parts);
    } else {
      table_.fail(lines_.number(),
                  fmt::format("found '{}', expected ITEM: ATOMS or ITEM: ENTRIES", line));
    }
  }

 private:
  void step() {
    if (!lines_.next())
      table_.fail(lines_.number(), "the dump ends here, expected more of its last step");
  }

  void box(const std::vector<std::string_view>& parts) {
    const bool tilted = parts.size() > 3 && parts[3] == "xy";
    const bool general = parts.size() > 3 && parts[3] == "abc";
    LammpsBox box;
    const std::size_t line = lines_.number();
    if (general) box.vectors.emplace();
    for (std::size_t k = 0; k < 3; ++k) {
      step();
      const std::vector<std::string_view> values = words(lines_.text());
      const auto value = [&](std::size_t m) { return lammps_number(table_, lines_, values, m); };
      if (general) {  // one vector a line, then a component of the corner
        (*box.vectors)[k] = {value(0), value(1), value(2)};
        box.low[k] = value(3);
        continue;
      }
      box.low[k] = value(0);
      box.high[k] = value(1);
      if (tilted) (k == 0 ? box.xy : k == 1 ? box.xz : box.yz) = value(2);
    }
    if (tilted) box.from_bounds();
    box.give(table_, line);
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

}  // namespace

bool is_lammps_dump(std::string_view text) { return text.starts_with("ITEM:"); }

void read_lammps_dump(SourceTable& table) {
  table.lammps = true;
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

}  // namespace verification
