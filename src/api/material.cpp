// Materials from a file or from text.
#include "api/guard.hpp"
#include "api/handle.hpp"
#include "material/material_file.hpp"

#include <grainlaw/grainlaw.h>

using namespace grainlaw::core;

namespace {

// Creates a handle; describe() returns the MaterialDescription.
template <class Describe>
grainlaw_status create(const void* source, grainlaw_material** out, api::MessageBuffer message,
                       Describe&& describe) {
  message.write("");
  if (out != nullptr) *out = nullptr;
  if (source == nullptr || out == nullptr) {
    message.write(grainlaw_status_text(GRAINLAW_NULL_POINTER));
    return GRAINLAW_NULL_POINTER;
  }
  return api::guarded([&] { *out = new grainlaw_material(make_any_material(describe())); },
                      message);
}

}  // namespace

grainlaw_status grainlaw_material_load(const char* path, grainlaw_material** out, char* message,
                                       size_t message_size) {
  return create(path, out, {message, message_size}, [&] { return read_material_file(path); });
}

grainlaw_status grainlaw_material_parse(const char* toml_text, const char* base_directory,
                                        grainlaw_material** out, char* message,
                                        size_t message_size) {
  return create(toml_text, out, {message, message_size}, [&] {
    const char* directory = base_directory == nullptr ? "." : base_directory;
    return parse_material(toml_text, directory, directory);
  });
}

int grainlaw_material_dimension(const grainlaw_material* handle) {
  if (api::check_handle(handle) != GRAINLAW_OK) return 0;
  return handle->material.index() == 0 ? 2 : 3;
}

void grainlaw_material_destroy(grainlaw_material* handle) {
  if (api::check_handle(handle) == GRAINLAW_OK) delete handle;
}
