// Common frame of the programs: signals, and exit codes of errors.
#pragma once

namespace CLI {
class App;
}

namespace verification {

// Runs the program. Exit codes: 0 done, 1 failed computation, 2 wrong input, 128 + signal: ended on
// request.
int run_program(CLI::App& app, int argc, char** argv);

}  // namespace verification
