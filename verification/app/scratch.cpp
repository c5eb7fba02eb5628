#include "app/scratch.hpp"

#include "app/library.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

namespace verification {

ScratchDirectory::ScratchDirectory() {
  std::error_code error;
  const auto directory = std::filesystem::temp_directory_path(error);
  std::string pattern =
      ((error ? std::filesystem::path("/tmp") : directory) / "grainlaw_XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr)
    throw ComputationError(fmt::format("{}: no directory for temporary files (TMPDIR): {}", pattern,
                                       std::strerror(errno)));
  path_ = std::filesystem::absolute(pattern);
}

ScratchDirectory::~ScratchDirectory() {
  std::error_code error;
  std::filesystem::remove_all(path_, error);
}

}  // namespace verification
