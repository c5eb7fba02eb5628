// The command `grainlaw`.

#include "app/commands.hpp"
#include "app/program.hpp"

#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
  CLI::App app("A constitutive law made of grains: drivers of representative volumes", "grainlaw");
  verification::add_point_command(app);
  verification::add_solve_command(app);
  verification::add_dns_command(app);
  verification::add_wave_command(app);
  verification::add_pack_command(app);
  verification::add_import_command(app);
  verification::add_export_command(app);
  verification::add_compare_command(app);
  verification::add_choose_command(app);
  verification::add_keys_command(app);
  return verification::run_program(app, argc, argv);
}
