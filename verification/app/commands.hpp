// The subcommands of `grainlaw`. Each function adds one to the command line; its callback runs the
// command and throws InputError or ComputationError.
#pragma once

namespace CLI {
class App;
}

namespace verification {

void add_point_command(CLI::App& app);
void add_solve_command(CLI::App& app);
void add_dns_command(CLI::App& app);
void add_wave_command(CLI::App& app);
void add_pack_command(CLI::App& app);
void add_compare_command(CLI::App& app);
void add_choose_command(CLI::App& app);
void add_import_command(CLI::App& app);
void add_export_command(CLI::App& app);
void add_keys_command(CLI::App& app);

}  // namespace verification
