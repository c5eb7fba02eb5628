// The material of a host's library: which file it is, read by whoever comes first.
#pragma once

#include <grainlaw/grainlaw.hpp>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

namespace grainlaw::adapters {

class MaterialFile {
 public:
  // `path` is as written into the library that holds the address in_library. The environment
  // variable GRAINLAW_MATERIAL_<name> goes before it. A relative path starts at that library's
  // folder. The variable's starts at the working directory in which the adapter was loaded, wherever
  // the host is by now.
  MaterialFile(const char* name, const char* path, const void* in_library);

  // Reads the file at the first call; threads that come meanwhile wait. Throws grainlaw::StatusError
  // with the library's message. A failure is kept, and thrown again at once, until the file changes
  // or a hundred times what the try took has passed: what the file names may be mended, too.
  const grainlaw::Material& material();

 private:
  struct Version {
    std::filesystem::file_time_type time;
    std::uintmax_t size;
    bool operator==(const Version&) const = default;
  };
  struct Failure {
    grainlaw::StatusError error;
    Version version;
    std::chrono::steady_clock::time_point keep_until;
  };

  [[nodiscard]] Version version() const;
  const grainlaw::Material& load();

  std::string path_;
  std::mutex loading_;
  std::atomic<const grainlaw::Material*> loaded_ = nullptr;  // material_, once it is there
  std::optional<grainlaw::Material> material_;
  std::optional<Failure> failure_;
};

}  // namespace grainlaw::adapters
