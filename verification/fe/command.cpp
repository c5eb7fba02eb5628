// `grainlaw solve SCENE.toml`: finite elements whose integration points are representative volumes.

#include "app/bounds.hpp"
#include "app/commands.hpp"
#include "fe/run.hpp"

#include <memory>
#include <string>

namespace verification {
void add_solve_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("solve", "solve a finite element scene with a packing in every point");
  auto scene = std::make_shared<std::string>();
  auto options = std::make_shared<RunOptions>();
  command->add_option("SCENE", *scene, "scene file (TOML)")->required();
  options->destination.add_options(*command);
  command->add_flag("--restart", options->restart,
                    "go on from NAME.checkpoint, as if the run had not been interrupted");
  command
      ->add_option("--checkpoint-every", options->checkpoint_every,
                   "write NAME.checkpoint every so many load steps (0: when interrupted only); "
                   "the scene's key checkpoint_every otherwise")
      ->check(at_least(0));
  command
      ->add_option("--stop-after", options->stop_after,
                   "end after this load step and leave NAME.checkpoint")
      ->check(at_least(0));
  command->callback([scene, options] { run_fe_scene(SceneFile(*scene), *options); });
}

}  // namespace verification
