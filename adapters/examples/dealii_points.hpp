// grainlaw in deal.II: the quadrature points of a mesh as one set of points.
#pragma once

#include <deal.II/base/quadrature.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <grainlaw/grainlaw.hpp>

#include <string>
#include <vector>

namespace grainlaw_dealii {

// The points of a two-dimensional displacement field (two components), all of one material. Nodal
// forces and stiffness are per metre of thickness.
class Points {
 public:
  Points(const dealii::Mapping<2>& mapping, const dealii::DoFHandler<2>& dofs,
         const dealii::Quadrature<2>& quadrature, const grainlaw::Material& material);

  // How long increments take from now on, for a material with solver.viscous_rate.
  void set_time_step(double step) { points_.set_time_step(step); }
  // Stress and exact tangent at I + grad u in all points. False when one found no equilibrium; then
  // message() and step_ratio() tell, and forces and stiffness stay those of the last success.
  // Throws grainlaw::StatusError where the library refuses, e.g. a NaN in u.
  bool evaluate(const dealii::Vector<double>& displacement);
  void commit();
  // Back to the committed states; forces and stiffness are theirs again.
  void revert();

  // The factor on the step that the failed points suggest, and the first of them in words.
  [[nodiscard]] double step_ratio() const { return last_.summary.step_ratio; }
  [[nodiscard]] std::string message() const { return last_.message(); }

  // Integrals of P : grad v and of grad v : A : grad u.
  void internal_forces(dealii::Vector<double>& forces) const;
  void stiffness(dealii::SparseMatrix<double>& matrix) const;

 private:
  [[nodiscard]] std::size_t point(unsigned cell, unsigned q) const {
    return std::size_t{cell} * quadrature_.size() + q;
  }

  const dealii::Mapping<2>& mapping_;
  const dealii::DoFHandler<2>& dofs_;
  dealii::Quadrature<2> quadrature_;
  grainlaw::Points points_;
  grainlaw::PointsEvaluation last_;
  std::vector<double> F_, P_, A_;          // P, A: of the last success
  std::vector<double> trial_P_, trial_A_;  // being evaluated
  std::vector<double> committed_P_, committed_A_;
};

}  // namespace grainlaw_dealii
