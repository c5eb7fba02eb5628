// Integration points of one material, driven through arrays: what the plugin does, without FreeFEM.
#pragma once

#include <grainlaw/grainlaw.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace grainlaw_freefem {

// Numbers of the script, first index fastest. One extent: the same numbers without the shape.
struct Array {
  double* data;
  std::vector<std::size_t> shape;
};

// Of the last evaluation.
struct Failure {
  double step_ratio = 1;  // smallest suggested factor on the step [-]
  long point = -1;        // the first that failed, -1: none
  std::string message;
};

// Every function throws std::exception with a text for the user; what is committed has then not
// changed.
class PointSet {
 public:
  // Points at F = I of the material of a file.
  PointSet(const std::string& material_path, long points);

  [[nodiscard]] long size() const { return static_cast<long>(states_.size()); }
  [[nodiscard]] long dimension() const { return dimension_; }

  // F[dim^2, n] -> P[dim^2, n] and, unless null, A[dim^4, n]: the exact tangent, in one batch.
  // Returns the number of points without an equilibrium, whose P and A keep what they held;
  // failure() tells about them. threads 0: as many as the library takes.
  long evaluate(const Array& F, const Array& P, const Array* A, long threads);
  [[nodiscard]] const Failure& failure() const { return failure_; }

  // All points, or none: refused unless the last evaluation found an equilibrium in each of them.
  void commit();
  void revert();

  // The committed states of all points as one file, and back: all of them, or none.
  void save(const std::string& path) const;
  void load(const std::string& path);

  // values[components, n] of a measure by its name in lower case, e.g. "void_ratio".
  void measure(const std::string& name, const Array& values) const;
  void write_vtk(long point, const std::string& path) const;

 private:
  void collect_handles();
  [[nodiscard]] std::string describe(std::size_t point) const;

  int dimension_ = 0;
  std::vector<grainlaw::abi::State> states_;
  std::vector<grainlaw_state*> handles_;
  std::vector<grainlaw_status> status_;
  std::vector<grainlaw_report> reports_;
  bool evaluated_ = false;  // all points hold the trial of the last evaluation
  Failure failure_;
};

}  // namespace grainlaw_freefem
