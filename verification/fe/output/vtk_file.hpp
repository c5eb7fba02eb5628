// VTK XML files of meshes and fields for ParaView. Arrays are base64 of their bytes: what is not a number
// stays so, and they are shorter than digits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace verification {

struct VtkArray {
  std::string name;
  int components = 1;  // 4: a tensor 11, 12, 21, 22
  std::vector<double> values;
};

struct VtkMesh {
  std::vector<double> points;              // x, y, z of each [m]
  std::vector<std::int64_t> connectivity;  // points of the cells one after the other
  std::vector<std::int64_t> offsets;       // end of every cell in it
  std::vector<std::uint8_t> types;         // VTK's numbers of the cell types
  std::vector<VtkArray> point_data;
  std::vector<VtkArray> cell_data;
};

// An unstructured grid (.vtu), and points alone (.vtp). Throw ComputationError when the file cannot be
// written.
void write_vtu(const std::filesystem::path& path, const VtkMesh& mesh);
void write_vtp(const std::filesystem::path& path, const std::vector<double>& points,
               const std::vector<VtkArray>& data);

// The files of a series and their times (.pvd); names relative to the file itself.
struct VtkSeriesEntry {
  double time = 0;
  std::string file;
};
void write_pvd(const std::filesystem::path& path, const std::vector<VtkSeriesEntry>& entries);

}  // namespace verification
