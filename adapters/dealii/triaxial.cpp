// The triaxial test of adapters/biaxial/triaxial.toml in deal.II 9.4.
//
//   [mpirun -n RANKS] dealii_triaxial MATERIAL.toml [PREFIX [STEPS [SHORTENING]]]
//
// prints the residuals of Newton's method, and writes PREFIX_force.csv and PREFIX_newton.csv.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/shared_tria.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/petsc_solver.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/petsc_vector.h>
#include <deal.II/lac/sparsity_tools.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <grainlaw/dealii.hpp>
#include <map>

#include "table.hpp"

using namespace dealii;
using Forces = PETScWrappers::MPI::Vector;
using Stiffness = PETScWrappers::MPI::SparseMatrix;

namespace {

constexpr double width = 0.05, height = 0.1;  // m
constexpr double side_pressure = 100e3;       // Pa, dead load
constexpr unsigned layers = 2;

// Dead load on a node of the sides, along an axis [N]: each has a quarter of the faces around it.
double side_force(const Point<3>& X, unsigned axis) {
  if (axis == 2) return 0;
  const double direction = X[axis] < 1e-9 ? 1 : -1;
  const bool end = X[2] < 1e-9 || X[2] > height - 1e-9;
  return direction * side_pressure * width * height / layers / (end ? 4 : 2);
}

void run(const char* material, const std::string& prefix, int steps, double shortening) {
  if (steps < 1) throw std::runtime_error("expected a number of load steps >= 1");
  const MPI_Comm comm = MPI_COMM_WORLD;
  parallel::shared::Triangulation<3> mesh(comm);
  GridGenerator::subdivided_hyper_rectangle(mesh, {1, 1, layers}, Point<3>(),
                                            Point<3>(width, width, height));
  const FESystem<3> element(FE_Q<3>(1), 3);
  const MappingQ1<3> mapping;
  DoFHandler<3> dofs(mesh);
  dofs.distribute_dofs(element);
  const IndexSet owned = dofs.locally_owned_dofs();
  IndexSet relevant;
  DoFTools::extract_locally_relevant_dofs(dofs, relevant);
  std::map<types::global_dof_index, Point<3>> where;
  DoFTools::map_dofs_to_support_points(mapping, dofs, where);
  std::array<IndexSet, 3> along;
  for (unsigned i = 0; i < 3; ++i)
    along[i] = DoFTools::extract_dofs(dofs, element.component_mask(FEValuesExtractors::Scalar(i)));
  DynamicSparsityPattern pattern(relevant);
  DoFTools::make_sparsity_pattern(dofs, pattern);
  SparsityTools::distribute_sparsity_pattern(pattern, owned, comm, relevant);
  Stiffness stiffness;
  stiffness.reinit(owned, owned, pattern, comm);
  Forces u(owned, comm);

  grainlaw::dealii::Points<3> points(mapping, dofs, QGauss<3>(2),
                                     grainlaw::dealii::read_material(comm, material));
  auto options = grainlaw_march_options_default();
  options.tolerance = 1e-10;
  const auto on_top = [&](auto d) { return where.at(d)[2] > height - 1e-9; };
  grainlaw::dealii::Newton<3, Forces, Stiffness> newton(
      points, u, stiffness,
      {.conditions =
           [&](double load, AffineConstraints<double>& prescribed) {
             for (const auto d : relevant)
               if (on_top(d) || where.at(d)[2] < 1e-9) {
                 prescribed.add_line(d);
                 prescribed.set_inhomogeneity(
                     d, on_top(d) && along[2].is_element(d) ? -shortening * load : 0);
               }
           },
       .external =
           [&](double, Forces& forces) {
             for (const auto d : owned)
               for (unsigned i = 0; i < 3; ++i)
                 if (along[i].is_element(d)) forces(d) += side_force(where.at(d), i);
             forces.compress(VectorOperation::add);
           },
       .solve =
           [&](const Stiffness& matrix, Forces& x, const Forces& b) {
             SolverControl control;
             PETScWrappers::SparseDirectMUMPS(control, comm).solve(matrix, x, b);
           },
       .tell = [](const std::string& text) { std::puts(text.c_str()); }},
      options);

  const bool tells = Utilities::MPI::this_mpi_process(comm) == 0;
  CsvTable force(prefix + "_force.csv", "step[-],fraction[-],top_z_displacement[m],top_z_force[N]");
  CsvTable iterations(prefix + "_newton.csv", "step[-],iteration[-],relative_residual[-]");
  for (int step = 0; step <= steps; ++step) {
    newton.to(static_cast<double>(step) / steps, [&](double load, const auto& residuals) {
      const Forces& internal = newton.internal_forces();
      double top_force = 0;
      for (const auto d : owned)
        if (on_top(d) && along[2].is_element(d)) top_force += internal(d);
      top_force = Utilities::MPI::sum(top_force, comm);
      force.add({double(step), load, -shortening * load, top_force});
      for (std::size_t k = 0; k < residuals.size(); ++k)
        iterations.add({double(step), double(k + 1), residuals[k]});
      if (!tells) return;
      std::printf("load %g: force %.6g N, residuals", load, top_force);
      for (const double value : residuals) std::printf(" %.1e", value);
      std::printf("\n");
      force.save();
      iterations.save();
    });
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2 || count > 5) {
    std::fprintf(stderr, "usage: dealii_triaxial MATERIAL.toml [PREFIX [STEPS [SHORTENING]]]\n");
    return 2;
  }
  const Utilities::MPI::MPI_InitFinalize mpi(count, arguments, 1);
  return grainlaw::dealii::end_together(MPI_COMM_WORLD, [&] {
    run(arguments[1], count > 2 ? arguments[2] : "triaxial",
        count > 3 ? std::atoi(arguments[3]) : 5, count > 4 ? std::atof(arguments[4]) : 5e-4);
  });
}
