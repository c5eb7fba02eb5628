#include "fe/output/vtk_file.hpp"

#include "app/atomic_file.hpp"
#include "app/text.hpp"
#include "io/vtk_xml.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string_view>

namespace verification {

using grainlaw::core::vtk_array;
using grainlaw::core::vtk_counts;
using grainlaw::core::vtk_file;

namespace {

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t group = 0;
    for (std::size_t b = 0; b < 3; ++b)
      group = group << 8 |
              (k + b < bytes.size() ? static_cast<std::uint8_t>(bytes[k + b]) : std::uint8_t{0});
    for (std::size_t d = 0; d < 4; ++d)
      text += k + d > bytes.size() ? '=' : digits[group >> (18 - 6 * d) & 63];
  }
  return text;
}

template <class T>
std::string encoded(const std::vector<T>& values) {
  const std::uint64_t size = values.size() * sizeof(T);
  std::string bytes(reinterpret_cast<const char*>(&size), sizeof size);
  bytes.append(reinterpret_cast<const char*>(values.data()), size);
  return base64(bytes);
}

std::string array(std::string_view type, std::string_view name, int components,
                  const std::string& values) {
  std::string names;  // of the components of a tensor
  const int rows = components == 4 ? 2 : components == 9 ? 3 : 0;
  for (int k = 0; k < rows * rows; ++k)
    fmt::format_to(std::back_inserter(names), " ComponentName{}=\"{}{}\"", k, k / rows + 1,
                   k % rows + 1);
  return vtk_array(type, xml_text(name), components, "binary", values + "\n", names);
}

std::string data(std::string_view element, const std::vector<VtkArray>& arrays) {
  std::string text = fmt::format("<{}>\n", element);
  for (const VtkArray& entry : arrays)
    text += array("Float64", entry.name, entry.components, encoded(entry.values));
  return text + fmt::format("</{}>\n", element);
}

std::string positions(const std::vector<double>& points) {
  return "<Points>\n" + array("Float64", "points", 3, encoded(points)) + "</Points>\n";
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const VtkMesh& mesh) {
  const std::string counts = fmt::format("NumberOfPoints=\"{}\" NumberOfCells=\"{}\"",
                                         mesh.points.size() / 3, mesh.offsets.size());
  const std::string cells = "<Cells>\n" +
                            array("Int64", "connectivity", 1, encoded(mesh.connectivity)) +
                            array("Int64", "offsets", 1, encoded(mesh.offsets)) +
                            array("UInt8", "types", 1, encoded(mesh.types)) + "</Cells>\n";
  write_file(path, vtk_file("UnstructuredGrid", counts,
                            positions(mesh.points) + cells + data("PointData", mesh.point_data) +
                                data("CellData", mesh.cell_data)));
}

void write_vtp(const std::filesystem::path& path, const std::vector<double>& points,
               const std::vector<VtkArray>& arrays) {
  const std::size_t count = points.size() / 3;
  std::vector<std::int64_t> connectivity, offsets;
  for (std::size_t k = 0; k < count; ++k) {
    connectivity.push_back(static_cast<std::int64_t>(k));
    offsets.push_back(static_cast<std::int64_t>(k + 1));
  }
  const std::string vertices = "<Verts>\n" +
                               array("Int64", "connectivity", 1, encoded(connectivity)) +
                               array("Int64", "offsets", 1, encoded(offsets)) + "</Verts>\n";
  write_file(path, vtk_file("PolyData", vtk_counts(count, count, 0),
                            positions(points) + vertices + data("PointData", arrays)));
}

void write_pvd(const std::filesystem::path& path, const std::vector<VtkSeriesEntry>& entries) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (const VtkSeriesEntry& entry : entries)
    fmt::format_to(std::back_inserter(text), "<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n",
                   entry.time, xml_text(entry.file));
  write_atomically(path, text + "</Collection>\n</VTKFile>\n");
}

}  // namespace verification
