// The time series of a run for ParaView: open the .pvd files.
#pragma once

#include "fe/output/vtk_file.hpp"
#include "fe/solver/solver.hpp"

#include <filesystem>
#include <vector>

namespace verification {

// STEM_mesh.pvd: the deformed mesh with displacement and reaction force (internal minus applied, per
// metre of thickness) at the nodes, and the means of all fields over each element, weighted by the
// area of its points. STEM_points.pvd: the integration points with all fields. STEM_packingN.pvd: the
// particles and force chains of point N.
class VtkSeries {
 public:
  // The model must outlive it.
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
