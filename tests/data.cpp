#include "data.hpp"

namespace grainlaw::test {

const std::string& data_folder() {
  static const std::string path = GRAINLAW_TEST_DATA;
  return path;
}

}  // namespace grainlaw::test
