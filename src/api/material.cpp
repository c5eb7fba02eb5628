// Materials from a file or from text.
#include "api/buffer.hpp"
#include "api/guard.hpp"
#include "api/handle.hpp"
#include "material/material_bytes.hpp"
#include "material/material_file.hpp"

#include <grainlaw/grainlaw.h>

#include <algorithm>
#include <cstddef>
#include <variant>
#include <vector>

using namespace grainlaw::core;

namespace {

// Creates a handle; describe() returns the material.
template <class Describe>
grainlaw_status create(const void* source, grainlaw_material** out, api::MessageBuffer message,
                       Describe&& describe) {
  message.write("");
  if (out != nullptr) *out = nullptr;
  if (source == nullptr || out == nullptr) {
    message.write(grainlaw_status_text(GRAINLAW_NULL_POINTER));
    return GRAINLAW_NULL_POINTER;
  }
  return api::guarded([&] { *out = new grainlaw_material(describe()); }, message);
}

std::vector<std::byte> saved(const grainlaw_material& handle) {
  return std::visit([](const auto& material) { return save_material(*material); }, handle.material);
}

}  // namespace

grainlaw_status grainlaw_material_load(const char* path, grainlaw_material** out, char* message,
                                       size_t message_size) {
  return create(path, out, {message, message_size},
                [&] { return make_any_material(read_material_file(path)); });
}

grainlaw_status grainlaw_material_parse(const char* toml_text, const char* base_directory,
                                        grainlaw_material** out, char* message,
                                        size_t message_size) {
  return create(toml_text, out, {message, message_size}, [&] {
    const char* directory = base_directory == nullptr ? "." : base_directory;
    return make_any_material(parse_material(toml_text, directory, directory));
  });
}

grainlaw_status grainlaw_material_load_saved(const void* bytes, size_t size,
                                             grainlaw_material** out, char* message,
                                             size_t message_size) {
  return create(bytes, out, {message, message_size}, [&] {
    return load_saved_material({static_cast<const std::byte*>(bytes), size});
  });
}

grainlaw_status grainlaw_material_save(const grainlaw_material* handle, void* bytes, size_t* size) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (size == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] {
    const std::vector<std::byte> all = saved(*handle);
    return api::save_to(bytes, size, all.size(),
                        [&](auto to) { std::copy(all.begin(), all.end(), to.begin()); });
  });
}

grainlaw_status grainlaw_material_fingerprint(const grainlaw_material* handle,
                                              unsigned long long* fingerprint) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (fingerprint == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] { *fingerprint = checksum_of_saved(saved(*handle)); });
}

int grainlaw_material_dimension(const grainlaw_material* handle) {
  if (api::check_handle(handle) != GRAINLAW_OK) return 0;
  return handle->material.index() == 0 ? 2 : 3;
}

void grainlaw_material_destroy(grainlaw_material* handle) {
  if (api::check_handle(handle) == GRAINLAW_OK) delete handle;
}
