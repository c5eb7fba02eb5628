// Any bytes as a checkpoint of `grainlaw solve`: as they are, and as the content of a sound one for each
// solver. The first byte chooses the solver.
#include "support.hpp"

#include "fe/checkpoint.hpp"
#include "fe/output/run_tables.hpp"
#include "fe/scene.hpp"

#include <vector>

namespace {

using namespace verification;

struct Case {
  FiniteElementScene scene;
  Material material;
};

// One element of the lattice under each solver, the first with a cycle.
const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    const std::string common =
        "steps = 2\nthreads = 1\n[mesh]\nsize = [1.0, 1.0]\ndivisions = [1, 1]\n"
        "[[displacement]]\non = 'left'\ncomponent = 'x'\nvalue = 0.0\n"
        "[[displacement]]\non = 'bottom'\ncomponent = 'y'\nvalue = 0.0\n"
        "[[displacement]]\non = 'top'\ncomponent = 'y'\nvalue = -1e-4\n"
        "[material]\n" +
        fuzz::lattice(fuzz::frictional);
    std::vector<Case> made;
    for (const std::string& solver :
         {std::string("solver = 'newton'\n"), std::string("solver = 'relaxation'\n"),
          std::string("solver = 'dynamics'\ndynamics = { density = 2000.0, duration = 1e-3 }\n")}) {
      const fuzz::MemoryFile file;
      file.write(solver + common);
      const SceneFile parsed(file.path());
      FiniteElementScene scene = read_fe_scene(parsed);
      Material material = make_material(scene.material);
      made.push_back({std::move(scene), std::move(material)});
    }
    return made;
  }();
  return all;
}

void read_as_run_does(CheckpointReader& in, const Case& c) {
  (void)in.get<std::string>();
  (void)in.get<std::string>();
  (void)in.get<int>();
  const RunTables tables("/nowhere", in);
  const auto solver = make_solver(c.scene.solver, c.scene.model, c.material, 1);
  solver->restore(in);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::MemoryFile file;
  if (size == 0) return 0;
  const Case& c = cases()[data[0] % cases().size()];
  const std::string bytes(reinterpret_cast<const char*>(data + 1), size - 1);
  file.write(bytes);
  try {
    CheckpointReader in = read_checkpoint(file.path());
    read_as_run_does(in, c);
  } catch (const InputError&) {
  } catch (const ComputationError&) {
  }
  try {
    CheckpointReader in(bytes, "fuzz");
    read_as_run_does(in, c);
  } catch (const InputError&) {
  } catch (const ComputationError&) {
  }
  return 0;
}
