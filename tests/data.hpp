// The packings that tests read.
#pragma once

#include <string>

namespace grainlaw::test {

// The folder, or a file in it. Compiled apart: every other object is the same in any checkout.
const std::string& data_folder();
inline std::string data_file(const std::string& name) { return data_folder() + "/" + name; }

}  // namespace grainlaw::test
