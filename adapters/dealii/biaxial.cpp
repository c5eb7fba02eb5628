// The biaxial test of adapters/biaxial/biaxial.toml in deal.II 9.4.
//
//   [mpirun -n RANKS] dealii_biaxial MATERIAL.toml [PREFIX [STEPS]]
//
// prints the residuals of Newton's method, and writes PREFIX_force.csv and PREFIX_newton.csv.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/shared_tria.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>
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
#include "triangles.hpp"

using namespace dealii;
using Forces = PETScWrappers::MPI::Vector;
using Stiffness = PETScWrappers::MPI::SparseMatrix;

namespace {

constexpr double width = 0.05, height = 0.1;  // m
constexpr double side_pressure = 100e3;       // Pa, dead load
constexpr double shortening = 1e-3;           // m, at full load
constexpr unsigned columns = 4, rows = 8;

// Dead load on a node of the sides, along x [N/m].
double side_force(const Point<2>& X) {
  const bool left = X[0]<1e-9, right = X[0]> width - 1e-9;
  if (!left && !right) return 0;
  const bool corner = X[1] < 1e-9 || X[1] > height - 1e-9;
  return (left ? 1 : -1) * side_pressure * height / rows * (corner ? 0.5 : 1);
}

void run(const char* material, const std::string& prefix, int steps) {
  if (steps < 1) throw std::runtime_error("expected a number of load steps >= 1");
  const MPI_Comm comm = MPI_COMM_WORLD;
  parallel::shared::Triangulation<2> mesh(comm);
  make_triangles(mesh, {{width, height}}, {{columns, rows}});
  const FESystem<2> element(FE_SimplexP<2>(1), 2);
  const MappingFE<2> mapping(FE_SimplexP<2>(1));
  DoFHandler<2> dofs(mesh);
  dofs.distribute_dofs(element);
  const IndexSet owned = dofs.locally_owned_dofs();
  IndexSet relevant;
  DoFTools::extract_locally_relevant_dofs(dofs, relevant);
  std::map<types::global_dof_index, Point<2>> where;
  DoFTools::map_dofs_to_support_points(mapping, dofs, where);
  const IndexSet in_y =
      DoFTools::extract_dofs(dofs, element.component_mask(FEValuesExtractors::Scalar(1)));
  DynamicSparsityPattern pattern(relevant);
  DoFTools::make_sparsity_pattern(dofs, pattern);
  SparsityTools::distribute_sparsity_pattern(pattern, owned, comm, relevant);
  Stiffness stiffness;
  stiffness.reinit(owned, owned, pattern, comm);
  Forces u(owned, comm);

  grainlaw::dealii::Points<2> points(mapping, dofs, QGaussSimplex<2>(1),
                                     grainlaw::dealii::read_material(comm, material));
  auto options = grainlaw_march_options_default();
  options.tolerance = 1e-10;
  const auto on_top = [&](auto d) { return where.at(d)[1] > height - 1e-9; };
  grainlaw::dealii::Newton<2, Forces, Stiffness> newton(
      points, u, stiffness,
      {.conditions =
           [&](double load, AffineConstraints<double>& prescribed) {
             for (const auto d : relevant)
               if (on_top(d) || where.at(d)[1] < 1e-9) {
                 prescribed.add_line(d);
                 prescribed.set_inhomogeneity(
                     d, on_top(d) && in_y.is_element(d) ? -shortening * load : 0);
               }
           },
       .external =
           [&](double, Forces& forces) {
             for (const auto d : owned)
               if (!in_y.is_element(d)) forces(d) += side_force(where.at(d));
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
  CsvTable force(prefix + "_force.csv",
                 "step[-],fraction[-],top_y_displacement[m],top_y_force[N/m]");
  CsvTable iterations(prefix + "_newton.csv", "step[-],iteration[-],relative_residual[-]");
  for (int step = 0; step <= steps; ++step) {
    newton.to(static_cast<double>(step) / steps, [&](double load, const auto& residuals) {
      const Forces& internal = newton.internal_forces();
      double top_force = 0;
      for (const auto d : owned)
        if (on_top(d) && in_y.is_element(d)) top_force += internal(d);
      top_force = Utilities::MPI::sum(top_force, comm);
      force.add({double(step), load, -shortening * load, top_force});
      for (std::size_t k = 0; k < residuals.size(); ++k)
        iterations.add({double(step), double(k + 1), residuals[k]});
      if (!tells) return;
      std::printf("load %g: force %.6g N/m, residuals", load, top_force);
      for (const double value : residuals) std::printf(" %.1e", value);
      std::printf("\n");
      force.save();
      iterations.save();
    });
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2 || count > 4) {
    std::fprintf(stderr, "usage: dealii_biaxial MATERIAL.toml [PREFIX [STEPS]]\n");
    return 2;
  }
  const Utilities::MPI::MPI_InitFinalize mpi(count, arguments, 1);
  return grainlaw::dealii::end_together(MPI_COMM_WORLD, [&] {
    run(arguments[1], count > 2 ? arguments[2] : "biaxial",
        count > 3 ? std::atoi(arguments[3]) : 20);
  });
}
