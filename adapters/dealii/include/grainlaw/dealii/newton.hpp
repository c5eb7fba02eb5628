// Newton's method over the points of a mesh, led by the library's march.
#pragma once

#include <deal.II/distributed/solution_transfer.h>
#include <deal.II/lac/affine_constraints.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <grainlaw/dealii/refinement.hpp>
#include <string>
#include <utility>
#include <vector>

namespace grainlaw::dealii {

// Equilibrium of displacements along a way of loads, by Newton's method; steps are cut and jumps crossed
// as a March decides. `u` and `matrix` are the caller's, with the sizes and entries of the field.
template <int dim, class Vector, class Matrix>
class Newton {
 public:
  // What the caller says: values of u that a load prescribes, with hanging nodes if any; forces of
  // external loads on free unknowns, added to a vector of zeros; the solution x of matrix x = b;
  // `tell`, why a step was cut, on rank 0.
  struct Problem {
    std::function<void(double load, ::dealii::AffineConstraints<double>&)> conditions;
    std::function<void(double load, Vector& forces)> external;
    std::function<void(const Matrix&, Vector& x, const Vector& b)> solve;
    std::function<void(const std::string&)> tell;
  };

  // The start is evaluated and committed. Throws where it has no equilibrium.
  Newton(Points<dim>& points, Vector& u, Matrix& matrix, Problem problem,
         const grainlaw_march_options& options = grainlaw_march_options_default())
      : points_(points),
        u_(u),
        matrix_(matrix),
        problem_(std::move(problem)),
        march_(&points.set(), options),
        internal_(u),
        external_(u),
        right_(u),
        correction_(u) {
    const auto found = points_.evaluate(u_);
    if (!found) throw StatusError(found.status, "no state to start from: " + found.message());
    points_.commit();
  }

  // To a load from where the last call ended, 0 at first; accepted(load, residuals) after each part of
  // it. Throws where the smallest part fails too.
  template <class Accepted>
  void to(double goal, Accepted&& accepted) {
    Vector committed(u_), farthest(u_);
    std::vector<double> residuals;
    march_.begin(reached_, goal);
    for (grainlaw_action now; (now = march_.next()) != GRAINLAW_DONE;) {
      const grainlaw_part& part = march_.part();
      if (part.keep) farthest = u_;
      if (now == GRAINLAW_SOLVE) {
        if (correct(part.load)) residuals.push_back(tell(part.load));
      } else if (now == GRAINLAW_CROSS) {
        u_ = farthest;
        tell(part.load);
      } else if (now == GRAINLAW_ACCEPT) {
        points_.commit();
        committed = u_;
        accepted(part.load, residuals);
        residuals.clear();
      } else {
        points_.revert();
        u_ = committed;
        residuals.clear();
        if (now == GRAINLAW_GIVE_UP) throw StatusError(GRAINLAW_NOT_CONVERGED, part.message);
        if (problem_.tell &&
            ::dealii::Utilities::MPI::this_mpi_process(points_.communicator()) == 0)
          problem_.tell("load " + shown(part.load) + ": " + part.message + "; the step is cut");
      }
    }
    reached_ = goal;
  }

  // Nodal forces of P, of all unknowns, in balance with the loads on the free ones [N, 2D: N/m].
  [[nodiscard]] const Vector& internal_forces() {
    points_.internal_forces(internal_);
    return internal_;
  }

  // Save and load points, u and the load that was reached.
  void save(const std::string& path) { points_.save(path, u_, reached_); }
  void load(const std::string& path) { reached_ = points_.load(path, u_); }

  // Refine, coarsen and share a mesh of p4est again by its flags. rebuild() gives field, u and matrix
  // their new sizes. u is interpolated, states go as Refinement says. What was lost.
  template <class Rebuild>
  Lost refine(typename Refinement<dim>::Mesh& mesh, Rebuild&& rebuild) {
    mesh.prepare_coarsening_and_refinement();
    Refinement<dim> change(points_, mesh);
    ::dealii::parallel::distributed::SolutionTransfer<dim, Vector> of_u(points_.dofs());
    const Vector all = points_.readable(u_);
    of_u.prepare_for_coarsening_and_refinement(all);
    mesh.execute_coarsening_and_refinement();
    rebuild();
    for (Vector* const v : {&internal_, &external_, &right_, &correction_}) v->reinit(u_);
    of_u.interpolate(u_);
    conditions(reached_, false).distribute(u_);
    return change.finish(u_);
  }

 private:
  // Conditions at a load: on u, or on its correction.
  [[nodiscard]] ::dealii::AffineConstraints<double> conditions(double load,
                                                               bool of_correction) const {
    ::dealii::IndexSet relevant;
    ::dealii::DoFTools::extract_locally_relevant_dofs(points_.dofs(), relevant);
    ::dealii::AffineConstraints<double> all(relevant);
    problem_.conditions(load, all);
    all.close();
    if (!of_correction) return all;
    const Vector at_ghosts = points_.readable(u_);
    // A hanging node may hang on a prescribed one: its line then has a part of the value, and is not of
    // a correction either.
    for (const auto& line : all.get_lines()) {
      double missing = line.inhomogeneity - at_ghosts(line.index);
      for (const auto& [other, weight] : line.entries) missing += weight * at_ghosts(other);
      all.set_inhomogeneity(line.index, missing);
    }
    return all;
  }

  // One solve; the increment of prescribed values enters through its right side. False: the stiffness is
  // singular.
  bool correct(double load) {
    const auto prescribed = conditions(load, true);
    points_.newton_system(matrix_, right_, prescribed);
    external_ = 0;
    problem_.external(load, external_);
    prescribed.set_zero(external_);
    right_ += external_;
    correction_ = 0;
    problem_.solve(matrix_, correction_, right_);
    prescribed.distribute(correction_);
    const double share = march_.share(points_.largest_change(correction_));
    if (share > 0) u_.add(share, correction_);
    return share > 0;
  }

  // Evaluates and tells the march norms over the unknowns that this rank owns. The relative residual.
  double tell(double load) {
    const auto found = points_.evaluate(u_);
    const auto prescribed = conditions(load, false);
    points_.internal_forces(internal_);
    points_.internal_forces(right_, prescribed);
    external_ = 0;
    problem_.external(load, external_);
    right_ -= external_;
    prescribed.set_zero(right_);
    march_.tell(found, own_norm(right_), own_norm(internal_));
    return right_.l2_norm() / internal_.l2_norm();
  }

  [[nodiscard]] double own_norm(const Vector& v) const {
    double squares = 0;
    for (const auto d : points_.dofs().locally_owned_dofs()) squares += std::pow(v(d), 2);
    return std::sqrt(squares);
  }

  static std::string shown(double load) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%g", load);
    return text.data();
  }

  Points<dim>& points_;
  Vector& u_;
  Matrix& matrix_;
  Problem problem_;
  March march_;
  Vector internal_, external_, right_, correction_;
  double reached_ = 0;
};

}  // namespace grainlaw::dealii
