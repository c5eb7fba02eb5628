// VTK XML files of meshes and fields for ParaView. Arrays are base64 of their bytes, which keeps
// NaN and is shorter than digits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace verification {

struct VtkArray {
  std::string name;
  int components = 1;  // 4 or 9: a tensor row by row
  std::vector<double> values;
};

struct VtkMesh {
  std::vector<double> points;              // x, y, z of each [m]
  std::vector<std::int64_t> connectivity;  // points of all cells in sequence
  std::vector<std::int64_t> offsets;       // end of every cell in connectivity
  std::vector<std::uint8_t> types;         // VTK's cell types
  std::vector<VtkArray> point_data;
  std::vector<VtkArray> cell_data;
};

// Writes an unstructured grid (.vtu), or points (.vtp). Throw ComputationError when the file cannot
// be written.
void write_vtu(const std::filesystem::path& path, const VtkMesh& mesh);
void write_vtp(const std::filesystem::path& path, const std::vector<double>& points,
               const std::vector<VtkArray>& data);

// Files of a series with their times (.pvd); names are relative to it.
struct VtkSeriesEntry {
  double time = 0;
  std::string file;
};
void write_pvd(const std::filesystem::path& path, const std::vector<VtkSeriesEntry>& entries);

}  // namespace verification
