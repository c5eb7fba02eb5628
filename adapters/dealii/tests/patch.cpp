// The patch through deal.II:  dealii_patch MATERIAL.toml PATH.csv > dealii.csv
//
// A unit square of triangles, or of spheres a unit cube that is one hexahedron, follows u = (F - I) X;
// P and A come back from the assembled nodal forces and stiffness, against virtual fields of unit
// gradients.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_matrix.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <grainlaw/dealii.hpp>
#include <sstream>

#include "../triangles.hpp"

using namespace dealii;

namespace {

// The numbers of a line, with commas between them.
std::vector<double> numbers(std::string line, std::size_t count) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream text(line);
  std::vector<double> found;
  for (double value; text >> value;) found.push_back(value);
  if (found.size() != count)
    throw std::runtime_error("expected " + std::to_string(count) + " components of F: " + line);
  return found;
}

template <int dim>
void run(const grainlaw::Material& material, const char* path_path,
         const FiniteElement<dim>& scalar, const Quadrature<dim>& quadrature) {
  constexpr unsigned square = dim * dim;
  Triangulation<dim> mesh;
  if constexpr (dim == 2)
    make_triangles(mesh, {{1, 1}}, {{1, 1}});
  else
    GridGenerator::hyper_cube(mesh);
  const FESystem<dim> element(scalar, dim);
  const MappingFE<dim> mapping(scalar);
  DoFHandler<dim> dofs(mesh);
  dofs.distribute_dofs(element);
  grainlaw::dealii::Points<dim> points(mapping, dofs, quadrature, material);
  points.set().set_time_step(1);
  std::vector<Point<dim>> where(dofs.n_dofs());
  DoFTools::map_dofs_to_support_points(mapping, dofs, where);
  // G X at the nodes.
  const auto field = [&](const std::vector<double>& G) {
    Vector<double> u(dofs.n_dofs());
    for (unsigned i = 0; i < dim; ++i)
      for (const auto d :
           DoFTools::extract_dofs(dofs, element.component_mask(FEValuesExtractors::Scalar(i))))
        for (unsigned J = 0; J < dim; ++J) u(d) += G[dim * i + J] * where[d][J];
    return u;
  };
  std::array<Vector<double>, square> unit;
  for (unsigned k = 0; k < square; ++k) {
    std::vector<double> G(square);
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
  std::printf("P and A by rows\n");
  while (std::getline(path, line)) {
    std::vector<double> F = numbers(line, square);
    for (unsigned i = 0; i < dim; ++i) F[i * (dim + 1)] -= 1;
    const auto found = points.evaluate(field(F));
    if (!found) throw std::runtime_error(found.message());
    points.commit();
    points.internal_forces(forces);
    points.newton_system(stiffness, right, none);
    for (unsigned k = 0; k < square; ++k)
      std::printf("%s%.17g", k == 0 ? "" : ",", unit[k] * forces);
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
    const auto material = grainlaw::Material::load(arguments[1]);
    if (material.dimension() == 2)
      run<2>(material, arguments[2], FE_SimplexP<2>(1), QGaussSimplex<2>(1));
    else
      run<3>(material, arguments[2], FE_Q<3>(1), QGauss<3>(2));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
