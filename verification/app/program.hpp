// What the programs share: signals, and how errors become exit codes.
#pragma once

namespace CLI {
class App;
}

namespace verification {

// Exit codes: 0 done, 1 a computation failed, 2 the input is wrong, 128 + signal: asked to end.
int run_program(CLI::App& app, int argc, char** argv);

}  // namespace verification
