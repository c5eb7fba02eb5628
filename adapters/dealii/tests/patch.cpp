// The patch through deal.II:  dealii_patch MATERIAL.toml PATH.csv > dealii.csv
//
// A unit square follows u = (F - I) X; P and A come back from the assembled nodal forces and
// stiffness, against virtual fields of unit gradients.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_matrix.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <grainlaw/dealii.hpp>

#include "../triangles.hpp"

using namespace dealii;

namespace {

void run(const char* material_path, const char* path_path) {
  Triangulation<2> mesh;
  make_triangles(mesh, {{1, 1}}, {{1, 1}});
  const FESystem<2> element(FE_SimplexP<2>(1), 2);
  const MappingFE<2> mapping(FE_SimplexP<2>(1));
  DoFHandler<2> dofs(mesh);
  dofs.distribute_dofs(element);
  grainlaw::dealii::Points<2> points(mapping, dofs, QGaussSimplex<2>(1),
                                     grainlaw::Material::load(material_path));
  points.set().set_time_step(1);
  std::vector<Point<2>> where(dofs.n_dofs());
  DoFTools::map_dofs_to_support_points(mapping, dofs, where);
  const IndexSet in_y =
      DoFTools::extract_dofs(dofs, element.component_mask(FEValuesExtractors::Scalar(1)));
  // G X at the nodes.
  const auto field = [&](const std::array<double, 4>& G) {
    Vector<double> u(dofs.n_dofs());
    for (types::global_dof_index d = 0; d < dofs.n_dofs(); ++d) {
      const unsigned i = in_y.is_element(d) ? 1 : 0;
      u(d) = G[2 * i] * where[d][0] + G[2 * i + 1] * where[d][1];
    }
    return u;
  };
  std::array<Vector<double>, 4> unit;
  for (unsigned k = 0; k < 4; ++k) {
    std::array<double, 4> G{};
    G[k] = 1;
    unit[k] = field(G);
  }
  DynamicSparsityPattern entries(dofs.n_dofs());
  DoFTools::make_sparsity_pattern(dofs, entries);
  SparsityPattern pattern;
  pattern.copy_from(entries);
  SparseMatrix<double> stiffness(pattern);
  Vector<double> forces(dofs.n_dofs()), right(dofs.n_dofs());
  AffineConstraints<double> none;
  none.close();

  std::ifstream path(path_path);
  std::string line;
  if (!std::getline(path, line)) throw std::runtime_error("the path cannot be read");
  std::printf("P and A in 20 columns\n");
  while (std::getline(path, line)) {
    std::array<double, 4> F{};
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &F[0], &F[1], &F[2], &F[3]) != 4)
      throw std::runtime_error("a line of the path is not F11,F12,F21,F22: " + line);
    F[0] -= 1;
    F[3] -= 1;
    const auto found = points.evaluate(field(F));
    if (!found) throw std::runtime_error(found.message());
    points.commit();
    points.internal_forces(forces);
    points.newton_system(stiffness, right, none);
    for (unsigned k = 0; k < 4; ++k) std::printf("%s%.17g", k == 0 ? "" : ",", unit[k] * forces);
    for (const auto& test : unit)
      for (const auto& trial : unit)
        std::printf(",%.17g", stiffness.matrix_scalar_product(test, trial));
    std::printf("\n");
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: dealii_patch MATERIAL.toml PATH.csv\n");
    return 2;
  }
  const Utilities::MPI::MPI_InitFinalize mpi(count, arguments, 1);
  try {
    run(arguments[1], arguments[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
