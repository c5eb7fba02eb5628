#include "app/state_files.hpp"

#include "app/atomic_file.hpp"
#include "app/library.hpp"
#include "app/scratch.hpp"

#include <fmt/format.h>

#include <string>

namespace verification {
namespace {

std::string text_of(const std::filesystem::path& path) {
  return as<ComputationError>([&] { return grainlaw::core::read_text(path.string()); });
}

}  // namespace

void write_packing(const grainlaw_state* state, const std::filesystem::path& prefix) {
  const ScratchDirectory scratch;
  check(grainlaw_state_write_packing(state, (scratch / "packing").c_str()),
        "writing " + prefix.string());
  const std::string particles = text_of(scratch / "packing_particles.csv"),
                    contacts = text_of(scratch / "packing_contacts.csv"),
                    cell = text_of(scratch / "packing_cell.csv");
  write_together({{prefix.string() + "_particles.csv", particles},
                  {prefix.string() + "_contacts.csv", contacts},
                  {prefix.string() + "_cell.csv", cell}});
}

void write_vtk(const grainlaw_state* state, const std::filesystem::path& path) {
  const ScratchDirectory scratch;
  const auto written = scratch / "state.vtp";
  check(grainlaw_state_write_vtk(state, written.c_str()), "writing " + path.string());
  write_file(path, text_of(written));
}

void write_vtk(const grainlaw_state* state, const std::filesystem::path& stem, int step) {
  write_vtk(state, fmt::format("{}_{:04d}.vtp", stem.string(), step));
}

}  // namespace verification
