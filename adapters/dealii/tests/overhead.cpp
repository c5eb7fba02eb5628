// What the adapter adds in deal.II per point: processor time of Points::evaluate on a mesh of 2048
// triangles, with the library's own function taken out. Beside it, what assembling Newton's matrix
// takes, which is deal.II's own.
//
//   dealii_overhead MATERIAL.toml
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_matrix.h>

#include <cstdio>
#include <ctime>
#include <exception>
#include <grainlaw/dealii.hpp>

#include "../triangles.hpp"

// In place of the library's.
grainlaw_status grainlaw_points_evaluate_some(grainlaw_points*, size_t, const size_t*,
                                              const double*, size_t, unsigned, double*, size_t,
                                              double*, size_t, grainlaw_status*, grainlaw_report*,
                                              int, grainlaw_summary*) {
  return GRAINLAW_OK;
}

using namespace dealii;

namespace {

template <class Work>
double per_point(std::size_t points, Work&& work) {
  constexpr int repeats = 100;
  const std::clock_t start = std::clock();
  for (int k = 0; k < repeats; ++k) work();
  return 1e6 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / repeats /
         static_cast<double>(points);
}

void run(const char* path) {
  Triangulation<2> mesh;
  make_triangles(mesh, {{1, 1}}, {{32, 32}});
  const FESystem<2> element(FE_SimplexP<2>(1), 2);
  const MappingFE<2> mapping(FE_SimplexP<2>(1));
  DoFHandler<2> dofs(mesh);
  dofs.distribute_dofs(element);
  grainlaw::dealii::Points<2> points(mapping, dofs, QGaussSimplex<2>(1),
                                     grainlaw::Material::load(path));
  DynamicSparsityPattern entries(dofs.n_dofs());
  DoFTools::make_sparsity_pattern(dofs, entries);
  SparsityPattern pattern;
  pattern.copy_from(entries);
  SparseMatrix<double> stiffness(pattern);
  const Vector<double> u(dofs.n_dofs());
  Vector<double> right(dofs.n_dofs());
  AffineConstraints<double> none;
  none.close();
  const std::size_t count = points.set().size();
  const double evaluate = per_point(count, [&] { points.evaluate(u); });
  const double assemble = per_point(count, [&] { points.newton_system(stiffness, right, none); });
  std::printf("%zu points: the adapter adds %.2f us per point and call; assembly %.2f us\n", count,
              evaluate, assemble);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: dealii_overhead MATERIAL.toml\n");
    return 2;
  }
  const Utilities::MPI::MPI_InitFinalize mpi(count, arguments, 1);
  try {
    run(arguments[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
