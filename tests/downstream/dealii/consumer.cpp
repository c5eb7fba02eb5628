// A host in deal.II, in one process: stretch a square of one cell by 0.1 %, commit, print its force.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>

#include <cstdio>
#include <grainlaw/dealii.hpp>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  return grainlaw::dealii::end_together(MPI_COMM_SELF, [&] {
    dealii::Triangulation<2> mesh;
    dealii::GridGenerator::hyper_cube(mesh);
    const dealii::FESystem<2> element(dealii::FE_Q<2>(1), 2);
    const dealii::MappingQ1<2> mapping;
    dealii::DoFHandler<2> dofs(mesh);
    dofs.distribute_dofs(element);
    grainlaw::dealii::Points<2> points(mapping, dofs, dealii::QGauss<2>(2),
                                       grainlaw::Material::load(argv[1]));
    dealii::Vector<double> u(dofs.n_dofs()), forces(dofs.n_dofs());
    u(7) = u(5) = -1e-3;  // the upper nodes down
    const auto found = points.evaluate(u);
    if (!found) throw std::runtime_error(found.message());
    points.commit();
    points.internal_forces(forces);
    std::printf("grainlaw %s in deal.II: force %.6g N/m\n", grainlaw_version(),
                forces(5) + forces(7));
  });
}
