// The quadrature points of a mesh of deal.II: stress, tangent, assembly, checkpoints.
#pragma once

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <grainlaw/dealii/cells_file.hpp>
#include <grainlaw/dealii/ranks.hpp>
#include <grainlaw/grainlaw.hpp>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace grainlaw::dealii {

template <int dim>
class Lending;
template <int dim>
class Refinement;

// The points of a displacement field with dim components, of one material; a rank has those of its
// cells, which may be none. In 2D forces and stiffness are per metre of thickness. Vectors are those of
// deal.II, PETSc or Trilinos, of the unknowns that a rank owns.
template <int dim>
class Points {
 public:
  // Throws for a material of another dimension, a mesh of several kinds of cells, and where ranks have
  // different materials.
  Points(const ::dealii::Mapping<dim>& mapping, const ::dealii::DoFHandler<dim>& dofs,
         const ::dealii::Quadrature<dim>& quadrature, const Material& material)
      : dofs_(dofs),
        comm_(dofs.get_communicator()),
        fingerprint_(material.fingerprint()),
        values_(mapping, dofs.get_fe(), quadrature,
                ::dealii::update_gradients | ::dealii::update_JxW_values),
        set_(material, 0) {
    const bool alone = ::dealii::Utilities::MPI::n_mpi_processes(comm_) == 1;
    const auto expected =
        alone ? fingerprint_ : ::dealii::Utilities::MPI::broadcast(comm_, fingerprint_, 0);
    together([&] {
      if (material.dimension() != dim)
        throw StatusError(GRAINLAW_BAD_ARGUMENT,
                          "a material of dimension " + std::to_string(material.dimension()) +
                              ", expected that of the mesh, " + std::to_string(dim));
      if (dofs_.has_hp_capabilities() || dofs_.get_triangulation().is_mixed_mesh())
        throw StatusError(GRAINLAW_BAD_ARGUMENT,
                          "a mesh of several kinds of cells or elements, expected one");
      if (fingerprint_ != expected)
        throw StatusError(GRAINLAW_WRONG_MATERIAL,
                          "the material is not that of rank 0: all need one file and packing");
      fit();
    });
    share();
  }
  Points(const Points&) = delete;
  Points& operator=(const Points&) = delete;

  // The points of this rank, by its cells; for measures and for a grainlaw::March.
  [[nodiscard]] grainlaw::Points& set() { return set_; }
  [[nodiscard]] MPI_Comm communicator() const { return comm_; }
  [[nodiscard]] const ::dealii::DoFHandler<dim>& dofs() const { return dofs_; }

  // Evaluate all points at I + grad u, with the exact tangent. Where one found no equilibrium the result
  // tells, and forces and stiffness stay those of the last success.
  template <class Vector>
  PointsEvaluation evaluate(const Vector& u) {
    together([&] { gradients(readable(u)); });
    for (std::size_t k = 0; k < F_.size(); k += square)
      for (unsigned i = 0; i < dim; ++i) F_[k + i * (dim + 1)] += 1;
    const auto found = evaluate_
                           ? evaluate_(F_, trial_P_, trial_A_)
                           : set_.evaluate(F_, trial_P_, GRAINLAW_WANT_TANGENT_EXACT, trial_A_);
    if (found) {
      P_.swap(trial_P_);
      A_.swap(trial_A_);
    }
    return found;
  }

  // Largest change of F by a correction, over the points of this rank (Frobenius norm) [-].
  template <class Vector>
  [[nodiscard]] double largest_change(const Vector& correction) {
    gradients(readable(correction));
    double largest = 0;
    for (std::size_t k = 0; k < F_.size(); k += square) {
      double squares = 0;
      for (std::size_t c = k; c < k + square; ++c) squares += F_[c] * F_[c];
      if (!(squares <= largest)) largest = squares;  // also one that is no number
      if (std::isnan(largest)) break;
    }
    return std::sqrt(largest);
  }

  void commit() {
    set_.commit();
    committed_P_ = P_;
    committed_A_ = A_;
  }
  // Back to the committed states; forces and stiffness are theirs again.
  void revert() {
    set_.revert();
    P_ = committed_P_;
    A_ = committed_A_;
  }

  // The integral of P : grad v for each test function v, hanging nodes and conditions resolved.
  template <class Vector>
  void internal_forces(Vector& forces, const ::dealii::AffineConstraints<double>& conditions =
                                           ::dealii::AffineConstraints<double>()) {
    forces = 0;
    assemble([&](const auto& indices, const auto& local,
                 const auto&) { conditions.distribute_local_to_global(local, indices, forces); },
             false);
    forces.compress(::dealii::VectorOperation::add);
  }

  // Newton's matrix, the integral of grad v : A : grad u, and what conditions on the correction and the
  // internal forces, with a minus, are on its right side.
  template <class Matrix, class Vector>
  void newton_system(Matrix& matrix, Vector& right,
                     const ::dealii::AffineConstraints<double>& conditions) {
    matrix = 0;
    right = 0;
    assemble(
        [&](const auto& indices, auto& local, const auto& stiffness) {
          local *= -1;
          conditions.distribute_local_to_global(stiffness, local, indices, matrix, right);
        },
        true);
    matrix.compress(::dealii::VectorOperation::add);
    right.compress(::dealii::VectorOperation::add);
  }

  // Write the committed states, displacements and a load to one file: the old one or the whole new one.
  template <class Vector>
  void save(const std::string& path, const Vector& u, double load) {
    Cells cells = owned_cells(set_);
    const Vector all = readable(u);
    each_cell([&](const auto& cell, std::size_t k) {
      ::dealii::Vector<double> local(dofs_.get_fe().n_dofs_per_cell());
      cell->get_dof_values(all, local);
      std::copy(local.begin(), local.end(), &cells.unknowns[k * local.size()]);
    });
    cells.save(path, load);
  }

  // Go on from a file of save(), written by any number of ranks for this mesh: states, forces, stiffness
  // and displacements have the bits that were saved. The load. Nothing changes where it throws.
  template <class Vector>
  double load(const std::string& path, Vector& u) {
    grainlaw::Points fresh(set_);
    Cells cells = owned_cells(fresh);
    const double load = cells.load(path);
    std::vector<std::size_t> all(set_.size());
    std::iota(all.begin(), all.end(), 0);
    set_.clone_some(all, fresh, all);
    const ::dealii::IndexSet& owned = dofs_.locally_owned_dofs();
    std::vector<::dealii::types::global_dof_index> indices(dofs_.get_fe().n_dofs_per_cell());
    each_cell([&](const auto& cell, std::size_t k) {
      cell->get_dof_indices(indices);
      for (std::size_t a = 0; a < indices.size(); ++a)
        if (owned.is_element(indices[a])) u(indices[a]) = cells.unknowns[k * indices.size() + a];
    });
    u.compress(::dealii::VectorOperation::insert);
    take_answer();
    return load;
  }

  // A vector with the values at ghosts, where its kind has them.
  template <class Vector>
  [[nodiscard]] Vector readable(const Vector& owned) const {
    if constexpr (requires(Vector v, ::dealii::IndexSet s) { v.reinit(s, s, comm_); }) {
      ::dealii::IndexSet relevant;
      ::dealii::DoFTools::extract_locally_relevant_dofs(dofs_, relevant);
      Vector all;
      all.reinit(dofs_.locally_owned_dofs(), relevant, comm_);
      all = owned;
      if constexpr (requires { all.update_ghost_values(); }) all.update_ghost_values();
      return all;
    } else {
      return owned;
    }
  }

  // P and A of the last success, by this rank's cells and points, row-major [Pa].
  [[nodiscard]] const std::vector<double>& P() const { return P_; }
  [[nodiscard]] const std::vector<double>& A() const { return A_; }

  // call(cell, k) for each cell that this rank owns, k counting from 0.
  template <class Call>
  void each_cell(Call&& call) const {
    std::size_t k = 0;
    for (const auto& cell : dofs_.active_cell_iterators())
      if (cell->is_locally_owned()) call(cell, k++);
  }

  // Numbers of this rank's cells in the whole mesh, for any number of ranks; of p4est its own order, in
  // which a rank's cells follow those of the rank before.
  [[nodiscard]] std::vector<std::uint64_t> numbers() const {
    using namespace ::dealii::parallel;
    const auto* const mesh = &dofs_.get_triangulation();
    std::vector<std::uint64_t> numbers;
    const auto* const forest = dynamic_cast<const distributed::Triangulation<dim>*>(mesh);
    together([&] {
      if (dynamic_cast<const fullydistributed::Triangulation<dim>*>(mesh) != nullptr)
        throw StatusError(GRAINLAW_BAD_ARGUMENT,
                          "cells of a fullydistributed mesh have no number for all ranks: "
                          "expected another kind of mesh");
      each_cell(
          [&](const auto& cell, std::size_t) { numbers.push_back(cell->active_cell_index()); });
    });
    if (forest == nullptr) return numbers;
    const auto& trees = forest->get_coarse_cell_to_p4est_tree_permutation();
    std::vector<std::pair<std::vector<std::uint64_t>, std::size_t>> order;
    each_cell([&](const auto& cell, std::size_t k) {
      const auto id = cell->id();
      std::vector<std::uint64_t> way{trees[id.get_coarse_cell_id()]};
      for (const auto child : id.get_child_indices()) way.push_back(child);
      order.emplace_back(way, k);
    });
    std::sort(order.begin(), order.end());
    std::uint64_t number = 0;
    const std::uint64_t own = order.size();
    MPI_Exscan(&own, &number, 1, MPI_UINT64_T, MPI_SUM, comm_);
    if (::dealii::Utilities::MPI::this_mpi_process(comm_) == 0) number = 0;
    for (const auto& [way, k] : order) numbers[k] = number++;
    return numbers;
  }

 private:
  friend class Lending<dim>;
  friend class Refinement<dim>;
  static constexpr std::size_t square = dim * dim;

  void share() {
    if (::dealii::Utilities::MPI::n_mpi_processes(comm_) > 1)
      set_.share(static_cast<int>(::dealii::Utilities::MPI::this_mpi_process(comm_)), reduce,
                 &comm_);
  }
  // Gives the set as many points as this rank's cells have now; new ones have new states.
  void fit() {
    std::size_t cells = 0;
    each_cell([&](const auto&, std::size_t) { ++cells; });
    set_.resize(cells * values_.n_quadrature_points);
    F_.resize(square * set_.size());
    P_.resize(square * set_.size());
    A_.resize(square * square * set_.size());
    trial_P_ = committed_P_ = P_;
    trial_A_ = committed_A_ = A_;
  }
  // P and A of states that came as bytes.
  void take_answer() {
    const auto found = set_.answer(P_, GRAINLAW_WANT_TANGENT_EXACT, A_);
    if (!found) throw StatusError(found.status, found.message());
    committed_P_ = P_;
    committed_A_ = A_;
  }

  template <class Call>
  void together(Call&& call) const {
    dealii::together(comm_, call);
  }

  static void reduce(void* comm, double* values, int n, grainlaw_op operation) {
    MPI_Allreduce(MPI_IN_PLACE, values, n, MPI_DOUBLE,
                  operation == GRAINLAW_MIN ? MPI_MIN : MPI_SUM, *static_cast<MPI_Comm*>(comm));
  }

  // grad u at all points, as F_.
  template <class Vector>
  void gradients(const Vector& all) {
    std::vector<::dealii::Tensor<2, dim>> found(values_.n_quadrature_points);
    each_cell([&](const auto& cell, std::size_t k) {
      values_.reinit(cell);
      values_[::dealii::FEValuesExtractors::Vector(0)].get_function_gradients(all, found);
      for (unsigned q = 0; q < found.size(); ++q)
        for (unsigned c = 0; c < square; ++c)
          F_[square * (k * found.size() + q) + c] = found[q][c / dim][c % dim];
    });
  }

  // add(indices, forces, stiffness) of each cell; the stiffness where it is wanted.
  template <class Add>
  void assemble(Add&& add, bool wants_stiffness) {
    const auto& element = dofs_.get_fe();
    const unsigned n = element.n_dofs_per_cell(), points = values_.n_quadrature_points;
    std::vector<::dealii::types::global_dof_index> indices(n);
    ::dealii::Vector<double> forces(n);
    ::dealii::FullMatrix<double> stiffness(n, n);
    each_cell([&](const auto& cell, std::size_t k) {
      values_.reinit(cell);
      cell->get_dof_indices(indices);
      forces = 0;
      stiffness = 0;
      for (unsigned q = 0; q < points; ++q) {
        const double* const P = &P_[square * (k * points + q)];
        const double* const A = &A_[square * square * (k * points + q)];
        for (unsigned a = 0; a < n; ++a) {
          const unsigned i = element.system_to_component_index(a).first;
          std::array<double, square> row{};  // grad v : A
          for (unsigned J = 0; J < dim; ++J) {
            const double gradient = values_.shape_grad(a, q)[J] * values_.JxW(q);
            forces(a) += P[dim * i + J] * gradient;
            for (unsigned c = 0; c < square; ++c)
              row[c] += gradient * A[square * (dim * i + J) + c];
          }
          if (!wants_stiffness) continue;
          for (unsigned b = 0; b < n; ++b) {
            const unsigned j = element.system_to_component_index(b).first;
            for (unsigned L = 0; L < dim; ++L)
              stiffness(a, b) += row[dim * j + L] * values_.shape_grad(b, q)[L];
          }
        }
      }
      add(indices, forces, stiffness);
    });
  }

  [[nodiscard]] Cells owned_cells(grainlaw::Points& points) const {
    Cells cells;
    cells.comm = comm_;
    cells.points = &points;
    cells.fingerprint = fingerprint_;
    cells.total = dofs_.get_triangulation().n_global_active_cells();
    cells.points_per_cell = values_.n_quadrature_points;
    cells.unknowns_per_cell = dofs_.get_fe().n_dofs_per_cell();
    cells.numbers = numbers();
    together([&] { cells.unknowns.resize(cells.numbers.size() * cells.unknowns_per_cell); });
    return cells;
  }

  const ::dealii::DoFHandler<dim>& dofs_;
  MPI_Comm comm_;
  unsigned long long fingerprint_;
  ::dealii::FEValues<dim> values_;
  grainlaw::Points set_;
  std::vector<double> F_, P_, A_;          // P, A: of the last success
  std::vector<double> trial_P_, trial_A_;  // being evaluated
  std::vector<double> committed_P_, committed_A_;
  // In place of the set's own evaluation, where points are lent.
  std::function<PointsEvaluation(std::span<const double> F, std::span<double> P,
                                 std::span<double> A)>
      evaluate_;
};

}  // namespace grainlaw::dealii
