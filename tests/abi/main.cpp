// Runs the tests, or, as the child of one of them, continues a saved state in a new process.
#include "continue_saved.hpp"
#include "support.hpp"

#include <cstdio>

int main(int argc, char** argv) {
  if (argc == 4 && std::string(argv[1]) == "--continue")
    return grainlaw::test::continue_saved(argv[2], argv[3]);
  testing::InitGoogleTest(&argc, argv);
  const int failed = RUN_ALL_TESTS();
  if (grainlaw::test::bad_inputs > 0)
    std::printf("bad input: %ld cases\n", grainlaw::test::bad_inputs);
  return failed;
}
