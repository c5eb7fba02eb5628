// Text of VTK's XML files. VTK's own writers would add two hundred packages.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace grainlaw::core {

// A DataArray. content: digits ("ascii"), or base64 of a UInt64 byte count and the bytes
// ("binary"); more: further attributes.
inline std::string vtk_array(std::string_view type, std::string_view name, int components,
                             std::string_view format, std::string_view content,
                             std::string_view more = "") {
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} format=\"{}\">\n{}"
      "</DataArray>\n",
      type, name, components, more, format, content);
}

// A whole file with one piece.
inline std::string vtk_file(std::string_view type, std::string_view counts,
                            std::string_view content) {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<{0}>\n<Piece {1}>\n{2}</Piece>\n"
      "</{0}>\n</VTKFile>\n",
      type, counts, content);
}

inline std::string vtk_counts(std::size_t points, std::size_t vertices, std::size_t lines) {
  return fmt::format(
      "NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\"",
      points, vertices, lines);
}

}  // namespace grainlaw::core
