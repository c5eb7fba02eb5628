#include "app/program.hpp"

#include "app/interrupt.hpp"
#include "app/library.hpp"
#include "app/progress.hpp"
#include "app/text.hpp"

#include <CLI/CLI.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

namespace verification {

namespace {

// Opens closed standard streams. A file would take their numbers and receive the messages.
void keep_streams_open() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1) static_cast<void>(open("/dev/null", O_RDWR));
}

}  // namespace

int run_program(CLI::App& app, int argc, char** argv) {
  keep_streams_open();
  // Failed writes return an error instead of a signal.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  app.set_version_flag("--version", std::string(grainlaw_version()));
  app.require_subcommand(1);
  const auto complain = [&](const std::exception& error) {
    tell(app.get_name() + ": " + terminal_text(error.what()) + "\n");
  };
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    // A misspelt word is told before what is missing for it.
    const std::vector<std::string> unknown = app.remaining(true);
    return unknown.empty() ? app.exit(error) : app.exit(CLI::ExtrasError(unknown)), 2;
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
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    tell(app.get_name() + ": results on the standard output could not be written\n");
    return 1;
  }
  return 0;
}

}  // namespace verification
