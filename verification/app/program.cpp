#include "app/program.hpp"

#include "app/interrupt.hpp"
#include "app/library.hpp"
#include "app/progress.hpp"
#include "app/text.hpp"

#include <CLI/CLI.hpp>

#include <csignal>
#include <exception>
#include <string>

namespace verification {

int run_program(CLI::App& app, int argc, char** argv) {
  // What cannot be written is an error that says so.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  app.set_version_flag("--version", std::string(grainlaw_version()));
  app.require_subcommand(1);
  const auto complain = [&](const std::exception& error) {
    tell(app.get_name() + ": " + terminal_text(error.what()) + "\n");
  };
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const Interrupted& interrupted) {
    return 128 + interrupted.signal;
  } catch (const InputError& error) {
    complain(error);
    return 2;
  } catch (const std::exception& error) {
    complain(error);
    return 1;
  }
  return 0;
}

}  // namespace verification
