#include "material_file.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>

namespace grainlaw::adapters {
namespace {

std::string locate(const char* name, const char* path, const void* in_library) {
  const char* other = std::getenv((std::string("GRAINLAW_MATERIAL_") + name).c_str());
  if (other != nullptr && *other != '\0') return other;
  Dl_info library{};
  if (std::filesystem::path(path).is_absolute() || dladdr(in_library, &library) == 0) return path;
  return std::filesystem::absolute(library.dli_fname).parent_path() / path;
}

}  // namespace

MaterialFile::MaterialFile(const char* name, const char* path, const void* in_library)
    : path_(locate(name, path, in_library)) {}

const abi::Material& MaterialFile::material() {
  std::call_once(once_, [this] { material_.emplace(abi::Material::load(path_)); });
  return *material_;
}

}  // namespace grainlaw::adapters
