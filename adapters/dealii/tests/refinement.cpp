// A mesh of p4est that is refined and coarsened in the middle of a test:
//
//   mpirun -n RANKS dealii_refinement MATERIAL.toml
//
// compares each state, byte for byte, with that of the nearest point of the cell it came from. It prints
// what was lost, and the force on the top at the end.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/petsc_solver.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/petsc_vector.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/numerics/vector_tools.h>

#include <cstdio>
#include <grainlaw/dealii.hpp>
#include <map>
#include <memory>
#include <stdexcept>

using namespace dealii;
using Forces = PETScWrappers::MPI::Vector;
using Stiffness = PETScWrappers::MPI::SparseMatrix;

namespace {

const MPI_Comm comm = MPI_COMM_WORLD;
constexpr unsigned per = 4;  // points of a cell

// The whole boundary moves: down and aside in proportion to the height until load 0.5, then it bends too.
class Moved : public Function<2> {
 public:
  explicit Moved(double load) : Function<2>(2), load_(load) {}
  double value(const Point<2>& X, unsigned component) const override {
    const double bend = std::max(0.0, load_ - 0.5) * X[0] * X[0];
    return X[1] * (component == 0 ? 1e-3 * load_ : -2e-3 * load_ - 1e-3 * bend);
  }

 private:
  double load_;
};

struct Problem {
  explicit Problem(const grainlaw::Material& material)
      : mesh(comm), element(FE_Q<2>(1), 2), dofs(mesh) {
    GridGenerator::subdivided_hyper_rectangle(mesh, {2, 1}, Point<2>(), Point<2>(2, 1), true);
    mesh.refine_global(1);
    size();
    points = std::make_unique<grainlaw::dealii::Points<2>>(mapping, dofs, QGauss<2>(2), material);
    auto options = grainlaw_march_options_default();
    options.tolerance = 1e-10;
    newton = std::make_unique<grainlaw::dealii::Newton<2, Forces, Stiffness>>(
        *points, u, stiffness,
        grainlaw::dealii::Newton<2, Forces, Stiffness>::Problem{
            [&](double load, AffineConstraints<double>& all) {
              DoFTools::make_hanging_node_constraints(dofs, all);
              for (const unsigned side : {0, 1, 2, 3})
                VectorTools::interpolate_boundary_values(mapping, dofs, side, Moved(load), all);
            },
            [](double, Forces&) {},
            [](const Stiffness& matrix, Forces& x, const Forces& b) {
              SolverControl control;
              PETScWrappers::SparseDirectMUMPS(control, comm).solve(matrix, x, b);
            },
            {}},
        options);
  }

  void size() {
    dofs.distribute_dofs(element);
    owned = dofs.locally_owned_dofs();
    DoFTools::extract_locally_relevant_dofs(dofs, relevant);
    AffineConstraints<double> hanging(relevant);
    DoFTools::make_hanging_node_constraints(dofs, hanging);
    hanging.close();
    DynamicSparsityPattern pattern(relevant);
    DoFTools::make_sparsity_pattern(dofs, pattern, hanging);  // PETSc drops what is not in it
    SparsityTools::distribute_sparsity_pattern(pattern, owned, comm, relevant);
    stiffness.reinit(owned, owned, pattern, comm);
    u.reinit(owned, comm);
  }

  void go(double load) {
    newton->to(load, [](double, const auto&) {});
  }

  [[nodiscard]] double top_force() const {
    const IndexSet top =
        DoFTools::extract_boundary_dofs(dofs, ComponentMask(std::vector<bool>{false, true}), {3});
    const Forces& internal = newton->internal_forces();
    double sum = 0;
    for (const auto d : owned)
      if (top.is_element(d)) sum += internal(d);
    return Utilities::MPI::sum(sum, comm);
  }

  parallel::distributed::Triangulation<2> mesh;
  FESystem<2> element;
  MappingQ1<2> mapping;
  DoFHandler<2> dofs;
  IndexSet owned, relevant;
  Stiffness stiffness;
  Forces u;
  std::unique_ptr<grainlaw::dealii::Points<2>> points;
  std::unique_ptr<grainlaw::dealii::Newton<2, Forces, Stiffness>> newton;
};

// A point of the mesh: where it lies, in which cell, the bytes of its state, its P.
struct At {
  double x = 0, y = 0;
  std::string state, P;
  int rank = 0;
  template <class Archive>
  void serialize(Archive& archive, unsigned) {
    archive& x& y& state& P& rank;
  }
};
using ByCell = std::map<std::string, std::vector<At>>;

// The points of all ranks, by the names of their cells, which begin with the names of the parents.
ByCell all_points(const Problem& problem) {
  ByCell own;
  FEValues<2> values(problem.mapping, problem.element, QGauss<2>(2), update_quadrature_points);
  problem.points->each_cell([&](const auto& cell, std::size_t k) {
    values.reinit(cell);
    const auto id = cell->id();
    std::string name = std::to_string(id.get_coarse_cell_id()) + ":";
    for (const auto child : id.get_child_indices()) name += std::to_string(child);
    for (unsigned q = 0; q < per; ++q) {
      const std::size_t point = k * per + q;
      const auto saved = problem.points->set().save_some(std::vector<std::size_t>{point});
      const auto* const P = reinterpret_cast<const char*>(&problem.points->P()[4 * point]);
      own[name].push_back(
          {values.quadrature_point(q)[0], values.quadrature_point(q)[1],
           std::string(reinterpret_cast<const char*>(saved.bytes.data()), saved.bytes.size()),
           std::string(P, 4 * sizeof(double)),
           static_cast<int>(Utilities::MPI::this_mpi_process(comm))});
    }
  });
  ByCell all;
  for (const auto& of_rank : Utilities::MPI::all_gather(comm, own))
    all.insert(of_rank.begin(), of_rank.end());
  return all;
}

// Points that changed their rank. Throws where one is no copy of the nearest of its old cell, of its
// parent or of the children that became its cell.
unsigned copies(const ByCell& before, const ByCell& after) {
  unsigned moved = 0;
  for (const auto& [name, points] : after)
    for (const At& point : points) {
      const At* nearest = nullptr;
      double least = 1e300;
      for (const auto& [old, candidates] : before) {
        const bool parent = name.compare(0, old.size(), old) == 0;
        const bool child = old.compare(0, name.size(), name) == 0;
        if (!parent && !child) continue;
        for (const At& candidate : candidates)
          if (const double far = std::hypot(candidate.x - point.x, candidate.y - point.y);
              far < least - 1e-12)
            nearest = &candidate, least = far;
      }
      if (nearest == nullptr) throw std::logic_error(name + ": of no old cell");
      if (point.state != nearest->state) throw std::logic_error(name + ": another state");
      if (point.P != nearest->P) throw std::logic_error(name + ": another P");
      moved += point.rank != nearest->rank;
    }
  return moved;
}

// Flags by the middle of a cell: 1 to refine, -1 to coarsen.
template <class Flag>
grainlaw::dealii::Lost change(Problem& problem, const char* what, std::size_t cells, Flag&& flag) {
  const ByCell before = all_points(problem);
  for (const auto& cell : problem.mesh.active_cell_iterators())
    if (cell->is_locally_owned()) {
      if (flag(cell->center()) > 0) cell->set_refine_flag();
      if (flag(cell->center()) < 0) cell->set_coarsen_flag();
    }
  const auto lost = problem.newton->refine(problem.mesh, [&] { problem.size(); });
  const ByCell after = all_points(problem);
  if (after.size() != cells)
    throw std::logic_error(std::string(what) + ": " + std::to_string(after.size()) + " cells");
  const unsigned moved = copies(before, after);
  if (Utilities::MPI::this_mpi_process(comm) == 0)
    std::printf(
        "%s: %zu cells before, %zu after; lost of the stress %.1e, of the energy %.1e, in "
        "strain %.1e; %u points on another rank\n",
        what, before.size(), after.size(), lost.stress, lost.energy, lost.strain, moved);
  std::fflush(stdout);
  return lost;
}

void expect(bool holds, const char* what) {
  if (!holds) throw std::logic_error(std::string("expected: ") + what);
}

void run(const char* material_path) {
  Problem problem(grainlaw::dealii::read_material(comm, material_path));
  for (const double load : {0.0, 0.25, 0.5}) problem.go(load);
  const auto left = [](const Point<2>& middle) { return middle[0] < 1 ? 1 : 0; };
  const auto sides = [](const Point<2>& middle) { return middle[0] < 1 ? -1 : 1; };
  const auto right = [](const Point<2>& middle) { return middle[0] > 1 ? -1 : 0; };
  // Uniformly strained: all states are as good as another. 1e-9: Newton's tolerance of 1e-10, and the
  // stiffness over the stress.
  for (const auto& lost : {change(problem, "refined", 20, left),
                           change(problem, "refined and coarsened", 20, sides)}) {
    expect(lost.stress < 1e-9 && lost.energy < 1e-9, "nothing lost where strain is uniform");
    expect(lost.strain < 1e-12, "F of the state is that of the mesh");
  }
  for (const double load : {0.75, 1.0}) problem.go(load);
  // Bent: a parent's weights are those of its children, but their strains differ from it.
  const auto refined = change(problem, "bent, refined", 32, left);
  expect(refined.stress < 1e-12 && refined.energy < 1e-12, "refinement keeps the integrals");
  expect(refined.strain > 1e-6, "a difference of strain is told");
  problem.go(1.1);
  const auto coarsened = change(problem, "bent, coarsened", 20, right);
  expect(coarsened.stress > 1e-6 && coarsened.energy > 1e-6, "what coarsening loses is told");
  problem.go(1.2);
  const double force = problem.top_force();
  if (Utilities::MPI::this_mpi_process(comm) == 0) std::printf("force %.17g\n", force);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  const Utilities::MPI::MPI_InitFinalize mpi(count, arguments, 1);
  return grainlaw::dealii::end_together(comm, [&] { run(arguments[1]); });
}
