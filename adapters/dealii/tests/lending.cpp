// Points of a mesh that ranks lend have the bits of those that they do not, also of a mesh that is refined:
//
//   mpirun -n RANKS dealii_lending MATERIAL.toml
//
// of discs or spheres. The upper part of a box yields, the lower one does not move.
#include <deal.II/base/function_lib.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/numerics/vector_tools.h>

#include <cstdio>
#include <cstring>
#include <grainlaw/dealii.hpp>
#include <grainlaw/dealii/lending.hpp>
#include <memory>
#include <stdexcept>

using namespace dealii;
using Field = LinearAlgebra::distributed::Vector<double>;

namespace {

const MPI_Comm comm = MPI_COMM_WORLD;

template <int dim>
class Moved : public Function<dim> {
 public:
  explicit Moved(double load) : Function<dim>(dim), load_(load) {}
  double value(const Point<dim>& X, unsigned component) const override {
    const double above = std::max(0.0, X[dim - 1] - 0.5);
    if (component == dim - 1) return -2e-3 * load_ * above;
    return component == 0 ? 1e-3 * load_ * above * above : 0;
  }

 private:
  double load_;
};

void expect(bool holds, const char* what) {
  if (!holds) throw std::logic_error(std::string("expected: ") + what);
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

template <int dim>
struct Box {
  explicit Box(const grainlaw::Material& material)
      : mesh(comm), element(FE_Q<dim>(1), dim), dofs(mesh) {
    GridGenerator::subdivided_hyper_rectangle(mesh, std::vector<unsigned>(dim, 2), Point<dim>(),
                                              dim == 2 ? Point<dim>(1, 1) : Point<dim>(1, 1, 1));
    size();
    for (auto* points : {&alone, &lends})
      *points =
          std::make_unique<grainlaw::dealii::Points<dim>>(mapping, dofs, QGauss<dim>(2), material);
    lending = std::make_unique<grainlaw::dealii::Lending<dim>>(*lends, material);
  }

  void size() {
    dofs.distribute_dofs(element);
    IndexSet relevant;
    DoFTools::extract_locally_relevant_dofs(dofs, relevant);
    u.reinit(dofs.locally_owned_dofs(), relevant, comm);
  }

  void move(double load) {
    VectorTools::interpolate(mapping, dofs, Moved<dim>(load), u);
    u.update_ghost_values();
  }

  // Two iterations, of which the last is committed.
  void step(double load) {
    for (auto* points : {&alone, &lends}) {
      (*points)->set().set_time_step(1);
      for (const double part : {0.95, 1.0}) {
        move(load - 1 + part);
        expect(static_cast<bool>((*points)->evaluate(u)), "an equilibrium");
      }
      (*points)->commit();
    }
    expect(same(alone->P(), lends->P()), "the P of points that are not lent");
    expect(same(alone->A(), lends->A()), "the A of points that are not lent");
    expect(alone->set().save() == lends->set().save(), "the states of points that are not lent");
  }

  void fail() {
    move(1000);
    const auto first = alone->evaluate(u), second = lends->evaluate(u);
    expect(!first && first.status == second.status, "the status of points that are not lent");
    expect(first.message() == second.message(), "the message of points that are not lent");
    expect(first.summary.failed == second.summary.failed, "as many failures");
    lends->revert();
    alone->revert();
  }

  void refine() {
    grainlaw::dealii::Refinement<dim> one(*alone, mesh), other(*lends, mesh);
    for (const auto& cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned() && cell->center()[0] < 0.5 && cell->center()[1] < 0.5)
        cell->set_refine_flag();
    mesh.execute_coarsening_and_refinement();
    size();
    move(2);
    one.finish(u);
    other.finish(u);
  }

  parallel::distributed::Triangulation<dim> mesh;
  FESystem<dim> element;
  MappingQ1<dim> mapping;
  DoFHandler<dim> dofs;
  Field u;
  std::unique_ptr<grainlaw::dealii::Points<dim>> alone, lends;
  std::unique_ptr<grainlaw::dealii::Lending<dim>> lending;
};

template <int dim>
void run(const grainlaw::Material& material) {
  Box<dim> box(material);
  for (const double load : {1.0, 2.0}) box.step(load);
  box.fail();
  box.refine();
  for (const double load : {3.0, 4.0}) box.step(load);
  const grainlaw_lent mine = box.lending->count();
  const long lent = Utilities::MPI::sum(mine.lent, comm),
             taken = Utilities::MPI::sum(mine.taken, comm);
  const unsigned ranks = Utilities::MPI::n_mpi_processes(comm);
  expect(lent == taken, "as many points lent as taken");
  expect((lent > 0) == (ranks > 1), "points that were lent");
  box.lending = nullptr;
  expect(static_cast<bool>(box.lends->evaluate(box.u)), "an equilibrium without lending");
  if (Utilities::MPI::this_mpi_process(comm) == 0)
    std::printf("%u ranks: %ld times a point was lent, the same bits\n", ranks, lent);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const Utilities::MPI::MPI_InitFinalize mpi(count, arguments, 1);
  return grainlaw::dealii::end_together(comm, [&] {
    const auto material = grainlaw::dealii::read_material(comm, arguments[1]);
    material.dimension() == 2 ? run<2>(material) : run<3>(material);
  });
}
