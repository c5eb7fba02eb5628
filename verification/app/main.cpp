// grainlaw: the command line of the verification drivers.
// Exit codes: 0 done, 1 a computation failed, 2 the input is wrong, 128 + signal: asked to end.

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/library.hpp"
#include "app/progress.hpp"
#include "app/text.hpp"

#include <csignal>
#include <exception>
#include <string>

int main(int argc, char** argv) {
  // What cannot be written is an error that says so.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App app("A constitutive law made of grains: drivers that verify it", "grainlaw");
  app.set_version_flag("--version", std::string(grainlaw_version()));
  app.require_subcommand(1);
  verification::add_point_command(app);
  verification::add_solve_command(app);
  verification::add_dns_command(app);
  verification::add_pack_command(app);
  verification::add_study_command(app);
  verification::add_wave_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const verification::Interrupted& interrupted) {
    return 128 + interrupted.signal;
  } catch (const verification::InputError& error) {
    verification::tell("grainlaw: " + verification::terminal_text(error.what()) + "\n");
    return 2;
  } catch (const std::exception& error) {
    verification::tell("grainlaw: " + verification::terminal_text(error.what()) + "\n");
    return 1;
  }
  return 0;
}
