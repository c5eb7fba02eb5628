#include "io/vtk.hpp"

#include "io/text_file.hpp"
#include "io/vtk_xml.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <vector>

namespace grainlaw::core {

namespace {

// An array of value(k) for k = 0..count-1, one per line.
template <class Value>
std::string array(const char* type, const char* name, int components, std::size_t count,
                  Value&& value) {
  fmt::memory_buffer digits;
  for (std::size_t k = 0; k < count; ++k) {
    fmt::format_to(fmt::appender(digits), "{}\n", value(k));
  }
  return vtk_array(type, name, components, "ascii", {digits.data(), digits.size()});
}

}  // namespace

void write_vtk(const std::string& path, std::span<const double> position,
               std::span<const double> radius, std::span<const double> rotation,
               std::span<const VtkContact> contacts) {
  const std::size_t n = radius.size();
  const std::size_t lines = contacts.size();
  const bool spatial = position.size() == 3 * n;
  std::vector<int> coordination(n + lines, 0);
  for (const VtkContact& c : contacts) {
    ++coordination[static_cast<std::size_t>(c.i)];
    ++coordination[static_cast<std::size_t>(c.j)];
  }
  // Value of point k: the first n points are particles.
  const auto of_particle = [&](std::span<const double> values, std::size_t k) {
    return k < n && !values.empty() ? values[k] : 0.0;
  };

  std::string text = "<PointData Scalars=\"radius\">\n";
  text += array("Float64", "radius", 1, n + lines,
                [&](std::size_t k) { return of_particle(radius, k); });
  const bool vectors = rotation.size() == 3 * n;
  text += array("Float64", "rotation", vectors ? 3 : 1, n + lines, [&](std::size_t k) {
    if (!vectors) return fmt::format("{}", of_particle(rotation, k));
    if (k >= n) return std::string("0 0 0");
    return fmt::format("{} {} {}", rotation[k], rotation[n + k], rotation[2 * n + k]);
  });
  text +=
      array("Int32", "coordination", 1, n + lines, [&](std::size_t k) { return coordination[k]; });
  text += "</PointData>\n<CellData Scalars=\"normal_force\">\n";
  text += array("Float64", "normal_force", 1, n + lines,
                [&](std::size_t k) { return k < n ? 0.0 : contacts[k - n].normal_force; });
  text += array("Float64", "tangential_force", 1, n + lines,
                [&](std::size_t k) { return k < n ? 0.0 : contacts[k - n].tangential_force; });
  text += array("Float64", "moment", 1, n + lines,
                [&](std::size_t k) { return k < n ? 0.0 : contacts[k - n].moment; });
  text += array("UInt8", "bonded", 1, n + lines,
                [&](std::size_t k) { return k >= n && contacts[k - n].bonded ? 1 : 0; });
  text += "</CellData>\n<Points>\n";
  text += array("Float64", "points", 3, n + lines, [&](std::size_t k) {
    const auto p = k < n ? k : static_cast<std::size_t>(contacts[k - n].i);
    const std::array<double, 3> to = k < n ? std::array<double, 3>{} : contacts[k - n].branch;
    return fmt::format("{} {} {}", position[p] + to[0], position[n + p] + to[1],
                       spatial ? position[2 * n + p] + to[2] : 0.0);
  });
  text += "</Points>\n<Verts>\n";
  text += array("Int64", "connectivity", 1, n, [](std::size_t k) { return k; });
  text += array("Int64", "offsets", 1, n, [](std::size_t k) { return k + 1; });
  text += "</Verts>\n<Lines>\n";
  text += array("Int64", "connectivity", 1, lines,
                [&](std::size_t k) { return fmt::format("{} {}", contacts[k].i, n + k); });
  text += array("Int64", "offsets", 1, lines, [](std::size_t k) { return 2 * (k + 1); });
  text += "</Lines>\n";
  write_text(path, vtk_file("PolyData", vtk_counts(n + lines, n, lines), text));
}

}  // namespace grainlaw::core
