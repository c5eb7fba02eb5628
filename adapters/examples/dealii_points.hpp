// grainlaw in deal.II: the quadrature points of a mesh as one set of points.
#pragma once

#include <deal.II/base/quadrature.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <grainlaw/grainlaw.hpp>

#include <vector>

namespace grainlaw_dealii {

// The points of a two-dimensional displacement field (two components), all of one material. Nodal
// forces and stiffness are per metre of thickness.
class Points {
 public:
  Points(const dealii::Mapping<2>& mapping, const dealii::DoFHandler<2>& dofs,
         const dealii::Quadrature<2>& quadrature, const grainlaw::Material& material);

  // For a grainlaw::March, which tells it the time.
  [[nodiscard]] grainlaw::Points& set() { return points_; }
  // Stress and exact tangent at I + grad u in all points. Where one found no equilibrium the result
  // tells, and forces and stiffness stay those of the last success. Throws grainlaw::StatusError where
  // the library refuses, e.g. a NaN in u.
  grainlaw::PointsEvaluation evaluate(const dealii::Vector<double>& displacement);
  // Largest change of F by a correction, over the points (Frobenius norm) [-].
  [[nodiscard]] double largest_change(const dealii::Vector<double>& correction);
  void commit();
  // Back to the committed states; forces and stiffness are theirs again.
  void revert();

  // Integrals of P : grad v and of grad v : A : grad u.
  void internal_forces(dealii::Vector<double>& forces) const;
  void stiffness(dealii::SparseMatrix<double>& matrix) const;

 private:
  [[nodiscard]] std::size_t point(unsigned cell, unsigned q) const {
    return std::size_t{cell} * quadrature_.size() + q;
  }

  // grad u at all points, as F_.
  void gradients(const dealii::Vector<double>& displacement);

  const dealii::Mapping<2>& mapping_;
  const dealii::DoFHandler<2>& dofs_;
  dealii::Quadrature<2> quadrature_;
  grainlaw::Points points_;
  std::vector<double> F_, P_, A_;          // P, A: of the last success
  std::vector<double> trial_P_, trial_A_;  // being evaluated
  std::vector<double> committed_P_, committed_A_;
};

}  // namespace grainlaw_dealii
