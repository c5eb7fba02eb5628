// Any text as a scene of every command that reads one.
#include "support.hpp"

#include "dns/scene.hpp"
#include "fe/scene.hpp"
#include "point/scene.hpp"
#include "wave/scene.hpp"

namespace {

using namespace verification;

// A scene, or a message.
template <class Read>
void read(const std::string& path, Read&& scene_from) {
  try {
    const SceneFile file(path);
    (void)scene_from(file);
  } catch (const InputError& error) {
    EXPECT(error.what()[0] != '\0');
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::MemoryFile file;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (fuzz::asks_for_much(text)) return -1;
  file.write(text);
  read(file.path(), read_point_scenes);
  read(file.path(), read_fe_scene);
  read(file.path(), read_specimen_scenes);
  read(file.path(), read_wave_scene);
  return 0;
}
