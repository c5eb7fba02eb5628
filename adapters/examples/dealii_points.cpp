#include "dealii_points.hpp"

#include <deal.II/fe/fe.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/full_matrix.h>

#include <cmath>

using namespace dealii;

namespace grainlaw_dealii {
namespace {

const FEValuesExtractors::Vector displacement_components(0);

}  // namespace

Points::Points(const Mapping<2>& mapping, const DoFHandler<2>& dofs,
               const Quadrature<2>& quadrature, const grainlaw::Material& material)
    : mapping_(mapping),
      dofs_(dofs),
      quadrature_(quadrature),
      points_(material, dofs.get_triangulation().n_active_cells() * quadrature.size()) {
  const std::size_t n = points_.size();
  F_.resize(4 * n);
  P_.resize(4 * n);
  A_.resize(16 * n);
  trial_P_ = committed_P_ = P_;
  trial_A_ = committed_A_ = A_;
}

void Points::gradients(const Vector<double>& displacement) {
  FEValues<2> values(mapping_, dofs_.get_fe(), quadrature_, update_gradients);
  std::vector<Tensor<2, 2>> found(quadrature_.size());
  for (const auto& cell : dofs_.active_cell_iterators()) {
    values.reinit(cell);
    values[displacement_components].get_function_gradients(displacement, found);
    for (unsigned q = 0; q < quadrature_.size(); ++q)
      for (unsigned c = 0; c < 4; ++c)
        F_[4 * point(cell->active_cell_index(), q) + c] = found[q][c / 2][c % 2];
  }
}

double Points::largest_change(const Vector<double>& correction) {
  gradients(correction);
  double largest = 0;
  for (std::size_t k = 0; k < F_.size(); k += 4) {
    const double norm = std::hypot(std::hypot(F_[k], F_[k + 1]), std::hypot(F_[k + 2], F_[k + 3]));
    if (!(norm <= largest)) largest = norm;  // also one that is no number
    if (std::isnan(largest)) break;
  }
  return largest;
}

grainlaw::PointsEvaluation Points::evaluate(const Vector<double>& displacement) {
  gradients(displacement);
  for (std::size_t k = 0; k < F_.size(); k += 4) {
    F_[k] += 1;
    F_[k + 3] += 1;
  }
  const auto found = points_.evaluate(F_, trial_P_, GRAINLAW_WANT_TANGENT_EXACT, trial_A_);
  if (found) {
    P_.swap(trial_P_);
    A_.swap(trial_A_);
  }
  return found;
}

void Points::commit() {
  points_.commit();
  committed_P_ = P_;
  committed_A_ = A_;
}

void Points::revert() {
  points_.revert();
  P_ = committed_P_;
  A_ = committed_A_;
}

void Points::internal_forces(Vector<double>& forces) const {
  forces = 0;
  FEValues<2> values(mapping_, dofs_.get_fe(), quadrature_, update_gradients | update_JxW_values);
  std::vector<types::global_dof_index> indices(dofs_.get_fe().n_dofs_per_cell());
  for (const auto& cell : dofs_.active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(indices);
    for (unsigned q = 0; q < quadrature_.size(); ++q) {
      const double* P = &P_[4 * point(cell->active_cell_index(), q)];
      for (unsigned a = 0; a < indices.size(); ++a) {
        const unsigned i = dofs_.get_fe().system_to_component_index(a).first;
        const Tensor<1, 2> gradient = values.shape_grad(a, q);
        forces(indices[a]) += (P[2 * i] * gradient[0] + P[2 * i + 1] * gradient[1]) * values.JxW(q);
      }
    }
  }
}

void Points::stiffness(SparseMatrix<double>& matrix) const {
  matrix = 0;
  FEValues<2> values(mapping_, dofs_.get_fe(), quadrature_, update_gradients | update_JxW_values);
  const unsigned n = dofs_.get_fe().n_dofs_per_cell();
  std::vector<types::global_dof_index> indices(n);
  FullMatrix<double> local(n, n);
  for (const auto& cell : dofs_.active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(indices);
    local = 0;
    for (unsigned q = 0; q < quadrature_.size(); ++q) {
      const double* A = &A_[16 * point(cell->active_cell_index(), q)];
      for (unsigned a = 0; a < n; ++a)
        for (unsigned b = 0; b < n; ++b) {
          const unsigned i = dofs_.get_fe().system_to_component_index(a).first;
          const unsigned k = dofs_.get_fe().system_to_component_index(b).first;
          double sum = 0;
          for (unsigned J = 0; J < 2; ++J)
            for (unsigned L = 0; L < 2; ++L)
              sum += values.shape_grad(a, q)[J] * A[((2 * i + J) * 2 + k) * 2 + L] *
                     values.shape_grad(b, q)[L];
          local(a, b) += sum * values.JxW(q);
        }
    }
    matrix.add(indices, local);
  }
}

}  // namespace grainlaw_dealii
