// The material of a host's library: which file it is, read by whoever comes first.
#pragma once

#include <grainlaw/grainlaw.hpp>

#include <mutex>
#include <optional>
#include <string>

namespace grainlaw::adapters {

class MaterialFile {
 public:
  // path as written into the library that holds the address in_library. The environment variable
  // GRAINLAW_MATERIAL_<name> goes before it; a relative path starts at that library's folder.
  MaterialFile(const char* name, const char* path, const void* in_library);

  // Reads the file at the first call; threads that come meanwhile wait. Throws abi::StatusError
  // with the library's message, and tries again at the next call.
  const abi::Material& material();

 private:
  std::string path_;
  std::once_flag once_;
  std::optional<abi::Material> material_;
};

}  // namespace grainlaw::adapters
