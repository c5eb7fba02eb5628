#include "app/output.hpp"

#include "app/library.hpp"
#include "app/text.hpp"

#include <fmt/format.h>

#include <system_error>

namespace verification {

std::filesystem::path output_stem(const std::string& directory, const std::string& name) {
  if (!is_file_name(name))
    throw InputError(fmt::format("--name: found \"{}\", expected {}", name, file_name_rule));
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!std::filesystem::is_directory(directory))
    throw InputError(
        fmt::format("--output {}: the directory cannot be made: {}", directory, error.message()));
  return std::filesystem::path(directory) / name;
}

}  // namespace verification
