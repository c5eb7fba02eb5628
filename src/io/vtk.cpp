#include "io/vtk.hpp"

#include "io/text_file.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <vector>

namespace grainlaw::core {

namespace {

using Text = fmt::memory_buffer;

template <class... Arguments>
void print(Text& text, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  fmt::format_to(fmt::appender(text), format, std::forward<Arguments>(arguments)...);
}

// value(k) for k = 0..count-1, one per line.
template <class Value>
void print_array(Text& text, const char* type, const char* name, int components, std::size_t count,
                 Value&& value) {
  print(text, "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n",
        type, name, components);
  for (std::size_t k = 0; k < count; ++k) print(text, "{}\n", value(k));
  print(text, "</DataArray>\n");
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
  // Of the points only the first n are particles.
  const auto of_particle = [&](std::span<const double> values, std::size_t k) {
    return k < n && !values.empty() ? values[k] : 0.0;
  };

  Text text;
  print(
      text,
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n",
      n + lines, n, lines);

  print(text, "<PointData Scalars=\"radius\">\n");
  print_array(text, "Float64", "radius", 1, n + lines,
              [&](std::size_t k) { return of_particle(radius, k); });
  const bool vectors = rotation.size() == 3 * n;
  print_array(text, "Float64", "rotation", vectors ? 3 : 1, n + lines, [&](std::size_t k) {
    if (!vectors) return fmt::format("{}", of_particle(rotation, k));
    if (k >= n) return std::string("0 0 0");
    return fmt::format("{} {} {}", rotation[k], rotation[n + k], rotation[2 * n + k]);
  });
  print_array(text, "Int32", "coordination", 1, n + lines,
              [&](std::size_t k) { return coordination[k]; });
  print(text, "</PointData>\n<CellData Scalars=\"normal_force\">\n");
  print_array(text, "Float64", "normal_force", 1, n + lines,
              [&](std::size_t k) { return k < n ? 0.0 : contacts[k - n].normal_force; });
  print_array(text, "Float64", "tangential_force", 1, n + lines,
              [&](std::size_t k) { return k < n ? 0.0 : contacts[k - n].tangential_force; });
  print_array(text, "Float64", "moment", 1, n + lines,
              [&](std::size_t k) { return k < n ? 0.0 : contacts[k - n].moment; });
  print_array(text, "UInt8", "bonded", 1, n + lines,
              [&](std::size_t k) { return k >= n && contacts[k - n].bonded ? 1 : 0; });
  print(text, "</CellData>\n<Points>\n");
  print_array(text, "Float64", "points", 3, n + lines, [&](std::size_t k) {
    const auto p = k < n ? k : static_cast<std::size_t>(contacts[k - n].i);
    const std::array<double, 3> to = k < n ? std::array<double, 3>{} : contacts[k - n].branch;
    return fmt::format("{} {} {}", position[p] + to[0], position[n + p] + to[1],
                       spatial ? position[2 * n + p] + to[2] : 0.0);
  });
  print(text, "</Points>\n<Verts>\n");
  print_array(text, "Int64", "connectivity", 1, n, [](std::size_t k) { return k; });
  print_array(text, "Int64", "offsets", 1, n, [](std::size_t k) { return k + 1; });
  print(text, "</Verts>\n<Lines>\n");
  print_array(text, "Int64", "connectivity", 1, lines,
              [&](std::size_t k) { return fmt::format("{} {}", contacts[k].i, n + k); });
  print_array(text, "Int64", "offsets", 1, lines, [](std::size_t k) { return 2 * (k + 1); });
  print(text, "</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n");
  write_text(path, fmt::to_string(text));
}

}  // namespace grainlaw::core
