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

// Every function throws std::exception with a text for the user; what is committed has then not
// changed.
class PointSet {
 public:
  // Points at F = I of materials of files, so many of each, one material after the other. Every
  // file is read before a point is made.
  PointSet(const std::vector<std::string>& material_paths, const std::vector<long>& points);

  [[nodiscard]] long size() const { return static_cast<long>(points_.size()); }
  [[nodiscard]] long dimension() const { return points_.dimension(); }

  // F[dim^2, n] -> P[dim^2, n] and, unless null, A[dim^4, n]: the exact tangent, in one batch.
  // Returns the number of points without an equilibrium, whose P and A keep what they held;
  // last() tells about them. threads 0: as many as the library takes.
  long evaluate(const Array& F, const Array& P, const Array* A, long threads);
  [[nodiscard]] const grainlaw::PointsEvaluation& last() const { return last_; }

  // P[dim^2, n] and, unless null, A[dim^4, n] as they were committed, without an increment: what a
  // script goes on from after a restart. Returns and last() as evaluate().
  long answer(const Array& P, const Array* A);

  // Leads all points to the Cauchy stresses sigma[dim^2, n] and makes that F = I; what they are
  // there goes to reached[dim^2, n]. Route: "k0" along the last axis, "proportional", "isotropic".
  void consolidate(const Array& sigma, const Array& reached, const std::string& route,
                   double overconsolidation);

  // How long increments take from now on: a material with solver.viscous_rate or solver.inertia asks
  // for it.
  void set_time_step(double step);

  // All points, or none: refused unless the last evaluation found an equilibrium in each of them.
  void commit();
  void revert();

  // The committed states of all points as one file, and back: all of them, or none.
  void save(const std::string& path) const;
  void load(const std::string& path);

  // values[components, n] of a measure by its name in lower case, e.g. "void_ratio".
  void measure(const std::string& name, const Array& values) const;
  void write_vtk(long point, const std::string& path) const;

  [[nodiscard]] grainlaw::Points& points() { return points_; }

 private:
  grainlaw::Points points_;
  grainlaw::PointsEvaluation last_;  // evaluation
};

}  // namespace grainlaw_freefem
