// Time series of a run for ParaView: open the .pvd files.
#pragma once

#include "fe/output/vtk_file.hpp"
#include "fe/solver/solver.hpp"

#include <filesystem>
#include <vector>

namespace verification {

// Writer of the series.
//   STEM_mesh.pvd      the deformed mesh: displacement and reaction force at nodes (internal minus
//                      applied), means of fields by element, weighted by area or volume;
//   STEM_points.pvd    the integration points with all fields;
//   STEM_packingN.pvd  particles and force chains of point N.
class VtkSeries {
 public:
  // `model` must outlive the series.
  VtkSeries(const Model& model, std::filesystem::path stem, std::vector<std::size_t> packings);

  void add(const LoadStep& step, const Solver& solver);

  void save(CheckpointWriter& out) const;
  void restore(CheckpointReader& in);

 private:
  [[nodiscard]] std::filesystem::path file(const std::string& kind, int step,
                                           const char* extension) const;
  void write_series(const std::string& kind, const char* extension) const;

  const Model& model_;
  std::filesystem::path stem_;
  std::vector<std::size_t> packings_;
  std::vector<double> times_;
  std::vector<int> steps_;
};

}  // namespace verification
