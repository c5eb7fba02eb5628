#include "material_file.hpp"

#include <dlfcn.h>

#include <array>
#include <climits>
#include <cstdlib>
#include <system_error>

namespace grainlaw::adapters {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int patience = 100;  // of the time that a failed try took, before the next one

// The working directory when the adapter was loaded.
const fs::path loaded_in = [] {
  std::error_code failed;
  return fs::current_path(failed);
}();

fs::path folder_of(const void* in_library) {
  Dl_info library{};
  if (dladdr(in_library, &library) == 0) return loaded_in;
#ifdef __GLIBC__
  // A name without a root is the host's, of the directory it was in; the loader noted that one.
  if (void* handle = dlopen(library.dli_fname, RTLD_LAZY | RTLD_NOLOAD); handle != nullptr) {
    std::array<char, 2 * PATH_MAX + 2> folder;  // a working directory and a name
    const bool found = dlinfo(handle, RTLD_DI_ORIGIN, folder.data()) == 0;
    dlclose(handle);
    if (found) return folder.data();
  }
#endif
  return (loaded_in / library.dli_fname).parent_path();
}

std::string locate(const char* name, const char* path, const void* in_library) {
  const char* other = std::getenv((std::string("GRAINLAW_MATERIAL_") + name).c_str());
  if (other != nullptr && *other != '\0') return loaded_in / other;
  return fs::path(path).is_absolute() ? path : folder_of(in_library) / path;
}

}  // namespace

MaterialFile::MaterialFile(const char* name, const char* path, const void* in_library)
    : path_(locate(name, path, in_library)) {}

const grainlaw::Material& MaterialFile::material() {
  if (const grainlaw::Material* loaded = loaded_.load(std::memory_order_acquire)) return *loaded;
  const std::lock_guard lock(loading_);
  return material_ ? *material_ : load();
}

const grainlaw::Material& MaterialFile::load() {
  const Version now = version();
  const Clock::time_point start = Clock::now();
  if (failure_ && failure_->version == now && start < failure_->keep_until) throw failure_->error;
  failure_.reset();
  try {
    loaded_.store(&material_.emplace(grainlaw::Material::load(path_)), std::memory_order_release);
  } catch (const grainlaw::StatusError& error) {
    // A lack of memory is not the file's.
    if (error.status() != GRAINLAW_OUT_OF_MEMORY) {
      const Clock::time_point end = Clock::now();
      failure_.emplace(error, now, end + patience * (end - start));
    }
    throw;
  }
  return *material_;
}

MaterialFile::Version MaterialFile::version() const {
  std::error_code missing;
  return {fs::last_write_time(path_, missing), fs::file_size(path_, missing)};
}

}  // namespace grainlaw::adapters
