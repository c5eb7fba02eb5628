// A test that is saved half way, or goes on from there; with hanging nodes, on a mesh of p4est:
//
//   mpirun -n RANKS dealii_restart MATERIAL.toml FILE save|load|refused [OTHER.toml]
//
// prints P, A and u of each cell half way, by the cell's number, and the force on the top at the end.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/hp/fe_collection.h>
#include <deal.II/lac/petsc_solver.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/petsc_vector.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/numerics/vector_tools.h>

#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <grainlaw/dealii.hpp>
#include <iterator>
#include <map>

using namespace dealii;
using Forces = PETScWrappers::MPI::Vector;
using Stiffness = PETScWrappers::MPI::SparseMatrix;

namespace {

const MPI_Comm comm = MPI_COMM_WORLD;

// The top moves down and aside.
class Moved : public Function<2> {
 public:
  explicit Moved(double load) : Function<2>(2), load_(load) {}
  double value(const Point<2>&, unsigned component) const override {
    return (component == 0 ? 2e-3 : -3e-3) * load_;
  }

 private:
  double load_;
};

// Two cells, refined, and one of them again.
struct Problem {
  explicit Problem(const grainlaw::Material& material, bool refined = true)
      : mesh(comm), element(FE_Q<2>(1), 2), dofs(mesh) {
    GridGenerator::subdivided_hyper_rectangle(mesh, {2, 1}, Point<2>(), Point<2>(2, 1), true);
    mesh.refine_global(1);
    if (refined) {
      for (const auto& cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned() && cell->center().norm() < 0.5) cell->set_refine_flag();
      mesh.execute_coarsening_and_refinement();
    }
    dofs.distribute_dofs(element);
    owned = dofs.locally_owned_dofs();
    DoFTools::extract_locally_relevant_dofs(dofs, relevant);
    DynamicSparsityPattern pattern(relevant);
    DoFTools::make_sparsity_pattern(dofs, pattern);
    SparsityTools::distribute_sparsity_pattern(pattern, owned, comm, relevant);
    stiffness.reinit(owned, owned, pattern, comm);
    u.reinit(owned, comm);
    points = std::make_unique<grainlaw::dealii::Points<2>>(mapping, dofs, QGauss<2>(2), material);
    AffineConstraints<double> hanging(relevant);
    DoFTools::make_hanging_node_constraints(dofs, hanging);
    hanging.close();
    start.reinit(owned, comm);
    if (const auto found = points->evaluate(u); !found) throw std::logic_error(found.message());
    points->internal_forces(start, hanging);
    auto options = grainlaw_march_options_default();
    options.tolerance = 1e-10;
    newton = std::make_unique<grainlaw::dealii::Newton<2, Forces, Stiffness>>(
        *points, u, stiffness,
        grainlaw::dealii::Newton<2, Forces, Stiffness>::Problem{
            [&](double load, AffineConstraints<double>& all) {
              DoFTools::make_hanging_node_constraints(dofs, all);
              VectorTools::interpolate_boundary_values(mapping, dofs, 2,
                                                       Functions::ZeroFunction<2>(2), all);
              VectorTools::interpolate_boundary_values(mapping, dofs, 3, Moved(load), all);
            },
            [&](double, Forces& forces) { forces += start; },
            [&](const Stiffness& matrix, Forces& x, const Forces& b) {
              SolverControl control;
              PETScWrappers::SparseDirectMUMPS(control, comm).solve(matrix, x, b);
            },
            {}},
        options);
  }

  // P, A and u of the cells of all ranks, in hexadecimal.
  [[nodiscard]] std::map<std::uint64_t, std::string> lines() const {
    std::map<std::uint64_t, std::string> own;
    Forces all(owned, relevant, comm);
    all = u;
    const auto numbers = points->numbers();
    points->each_cell([&](const auto& cell, std::size_t k) {
      std::string line;
      const auto add = [&](double value) {
        char text[40];
        std::snprintf(text, sizeof text, " %a", value);
        line += text;
      };
      for (std::size_t c = 16 * k; c < 16 * (k + 1); ++c) add(points->P()[c]);
      for (std::size_t c = 64 * k; c < 64 * (k + 1); ++c) add(points->A()[c]);
      Vector<double> local(element.n_dofs_per_cell());
      cell->get_dof_values(all, local);
      for (const double value : local) add(value);
      own[numbers[k]] = line;
    });
    std::map<std::uint64_t, std::string> told;
    for (const auto& of_rank : Utilities::MPI::all_gather(comm, own))
      told.insert(of_rank.begin(), of_rank.end());
    return told;
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

  void go(double load) {
    newton->to(load, [](double, const auto&) {});
  }

  parallel::distributed::Triangulation<2> mesh;
  FESystem<2> element;
  MappingQ1<2> mapping;
  DoFHandler<2> dofs;
  IndexSet owned, relevant;
  Stiffness stiffness;
  Forces u, start;  // loads: those that balance the first stress
  std::unique_ptr<grainlaw::dealii::Points<2>> points;
  std::unique_ptr<grainlaw::dealii::Newton<2, Forces, Stiffness>> newton;
};

// The call throws on every rank the same words, and P, A and u stay.
template <class Call>
void refused(Problem& problem, grainlaw_status status, const std::string& words, Call&& call) {
  const auto before = problem.lines();
  try {
    call();
  } catch (const grainlaw::StatusError& error) {
    if (error.status() != status || std::string(error.what()).find(words) == std::string::npos)
      throw std::logic_error("expected \"" + words + "\", got \"" + error.what() + "\"");
    for (const std::string& text : Utilities::MPI::all_gather(comm, std::string(error.what())))
      if (text != error.what()) throw std::logic_error("ranks tell another text: " + text);
    if (problem.lines() != before) throw std::logic_error(words + ": something changed");
    return;
  }
  throw std::logic_error(words + ": not refused");
}

using Damage = void (*)(hid_t);

template <class Value>
void fill(hid_t file, const char* name, hid_t type, Value value) {
  const hid_t set = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(set);
  const std::vector<Value> all(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)),
                               value);
  H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data());
  H5Sclose(space);
  H5Dclose(set);
}

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void refuse(const grainlaw::Material& material, const std::string& path, const char* other_path) {
  Problem problem(material), coarse(material, false);
  const auto other = grainlaw::dealii::read_material(comm, other_path);
  Problem stiffer(other);
  const unsigned rank = Utilities::MPI::this_mpi_process(comm);
  const unsigned last = Utilities::MPI::n_mpi_processes(comm) - 1;
  const auto loads = [&](Problem& one, const std::string& from) {
    return [&one, from] { one.newton->load(from); };
  };
  refused(problem, GRAINLAW_FILE_ERROR, "nowhere.cells", loads(problem, "nowhere.cells"));
  refused(coarse, GRAINLAW_BAD_ARGUMENT, "the checkpoint has 11 cells, expected 8",
          loads(coarse, path));
  refused(stiffer, GRAINLAW_WRONG_MATERIAL, "of another material", loads(stiffer, path));
  const std::string saved = contents(path), damaged = path + ".damaged";
  for (const auto& [damage, words] : std::initializer_list<std::pair<Damage, const char*>>{
           {[](hid_t file) { fill(file, "states", H5T_NATIVE_UINT8, std::uint8_t(0)); }, "cell "},
           {[](hid_t file) { fill(file, "lengths", H5T_NATIVE_UINT64, std::uint64_t(1) << 40); },
            "its states are cut short"},
           {[](hid_t file) { H5Ldelete(file, "starts", H5P_DEFAULT); },
            "the checkpoint has no starts"},
           {[](hid_t file) { H5Adelete(file, "format"); }, "expected a checkpoint of cells"}}) {
    if (rank == 0) {
      std::ofstream(damaged, std::ios::binary) << saved;
      const hid_t file = H5Fopen(damaged.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
      damage(file);
      H5Fclose(file);
    }
    MPI_Barrier(comm);
    refused(problem, GRAINLAW_BAD_BYTES, words, loads(problem, damaged));
  }
  for (const auto& bytes : {saved.substr(0, saved.size() - 100), "x" + saved.substr(1)}) {
    if (rank == 0) std::ofstream(damaged, std::ios::binary) << bytes;
    MPI_Barrier(comm);
    refused(problem, GRAINLAW_BAD_BYTES, "is cut short, or no HDF5 file", loads(problem, damaged));
  }
  if (rank == 0) std::remove(damaged.c_str());
  const rlimit half{saved.size() / 2, RLIM_INFINITY}, none{RLIM_INFINITY, RLIM_INFINITY};
  std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &half);
  refused(problem, GRAINLAW_FILE_ERROR, "File too large", [&] { problem.newton->save(path); });
  setrlimit(RLIMIT_FSIZE, &none);
  if (contents(path) != saved) throw std::logic_error("a full disk: the last checkpoint is gone");
  // A square beside a triangle, each of its own element.
  Triangulation<2> mixed_mesh;
  std::vector<CellData<2>> kinds{CellData<2>(4), CellData<2>(3)};
  kinds[0].vertices = {0, 1, 2, 3};
  kinds[1].vertices = {1, 4, 3};
  mixed_mesh.create_triangulation(
      {Point<2>(0, 0), Point<2>(1, 0), Point<2>(0, 1), Point<2>(1, 1), Point<2>(2, 0)}, kinds,
      SubCellData());
  const hp::FECollection<2> elements(FESystem<2>(FE_Q<2>(1), 2), FESystem<2>(FE_SimplexP<2>(1), 2));
  DoFHandler<2> mixed_dofs(mixed_mesh);
  for (const auto& cell : mixed_dofs.active_cell_iterators())
    cell->set_active_fe_index(cell->reference_cell().is_simplex() ? 1 : 0);
  mixed_dofs.distribute_dofs(elements);
  refused(problem, GRAINLAW_BAD_ARGUMENT, "a mesh of several kinds of cells", [&] {
    const grainlaw::dealii::Points<2> mixed(problem.mapping, mixed_dofs, QGauss<2>(2), material);
  });
  refused(problem, GRAINLAW_WRONG_MATERIAL, "rank " + std::to_string(last) + ": the material", [&] {
    const grainlaw::dealii::Points<2> mixed(problem.mapping, problem.dofs, QGauss<2>(2),
                                            rank == last ? other : material);
  });
}

void run(const char* material_path, const std::string& path, const std::string& what,
         const char* other) {
  const auto material = grainlaw::dealii::read_material(comm, material_path);
  if (what == "refused") return refuse(material, path, other);
  Problem problem(material);
  if (what == "save") {
    for (const double load : {0.0, 0.25, 0.5}) problem.go(load);
    problem.newton->save(path);
  } else {
    problem.newton->load(path);
  }
  const auto half = problem.lines();
  for (const double load : {0.75, 1.0}) problem.go(load);
  const double force = problem.top_force();
  if (Utilities::MPI::this_mpi_process(comm) != 0) return;
  for (const auto& [number, line] : half)
    std::printf("%llu%s\n", static_cast<unsigned long long>(number), line.c_str());
  std::printf("%.17g\n", force);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 4) return 2;
  const Utilities::MPI::MPI_InitFinalize mpi(count, arguments, 1);
  return grainlaw::dealii::end_together(
      comm, [&] { run(arguments[1], arguments[2], arguments[3], count > 4 ? arguments[4] : ""); });
}
