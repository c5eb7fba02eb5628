// Keys of material files, as their readers ask for them.
#include "api/guard.hpp"
#include "base/error.hpp"
#include "material/material_file.hpp"

#include <grainlaw/grainlaw.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

using namespace grainlaw::core;

namespace {

// Examples that together ask for every key: readers depend on dimension, generator, law and
// boundary.
constexpr std::string_view discs = R"(
dimension = 2
thickness = 1
[packing]
generator = "compaction"
count = 2
radii = [1, 1]
seed = 1
pressure = 1
friction = 1
anisotropy = 0.1
[contact]
law = "frictional"
kn = 1
ratio = 1
friction = 1
rolling = { ratio = 1, friction = 1 }
)";
constexpr std::string_view files = R"(
dimension = 2
packing = { particles = "none", cell = "none" }
contact = { law = "hertz", shear_modulus = 1, poisson = 0, friction = 1 }
)";
constexpr std::string_view frame = R"(
dimension = 2
thickness = 1
[packing]
generator = "square"
columns = 2
rows = 2
radius = 1
overlap = 0
radius_spread = 0.1
seed = 1
[contact]
law = "bonded"
kn = 1
ratio = 1
friction = 1
bond = { normal_strength = 1, tangential_strength = 1 }
[boundary]
type = "mixed"
left = { x = "D" }
right = { x = "D" }
bottom = { x = "D" }
top = { x = "D" }
stress = { P22 = -1 }
)";
constexpr std::string_view spheres = R"(
dimension = 3
[packing]
generator = "lubachevsky-stillinger"
count = 2
radii = [1, 1]
seed = 1
pressure = 1
friction = 1
anisotropy = 0.1
[contact]
law = "bonded"
kn = 1
ratio = 1
friction = 1
bond = { normal_strength = 1, tangential_strength = 1 }
rolling = { ratio = 1, friction = 1 }
)";
constexpr std::string_view lattice = R"(
dimension = 3
packing = { generator = "fcc", cells = [1, 1, 1], radius = 1, pressure = 1 }
contact = { law = "compressive", kn = 1 }
)";

KeyLog log_of(std::string_view example) {
  KeyLog log;
  try {
    static_cast<void>(parse_material(example, "", "example", &log));
  } catch (const Error& error) {
    // Missing files are ignored: every key has been asked for by then.
    if (error.status != GRAINLAW_FILE_ERROR) throw;
  }
  return log;
}

// Expectation of discs and of spheres, where they differ.
std::string both(const std::string& of_discs, const std::string& of_spheres) {
  if (of_discs.find(of_spheres) != std::string::npos) return of_discs;
  if (of_discs.empty()) return of_spheres;
  return of_discs + "; of spheres " + of_spheres;
}

std::string table_of(const std::string& path) { return path.substr(0, path.rfind('.')); }

// Inserts a key after the last one of its table.
void merge(KeyLog& all, const AskedKey& key) {
  const auto same = [&](const AskedKey& other) { return other.path == key.path; };
  const auto known = std::ranges::find_if(all, same);
  if (known != all.end()) {
    known->expected = both(known->expected, key.expected);
    return;
  }
  const auto beside = std::find_if(all.rbegin(), all.rend(), [&](const AskedKey& other) {
    return table_of(other.path) == table_of(key.path);
  });
  all.insert(beside.base() == all.begin() ? all.end() : beside.base(), key);
}

std::string all_keys() {
  KeyLog all;
  for (const std::string_view example : {discs, files, frame, spheres, lattice})
    for (const AskedKey& key : log_of(example)) merge(all, key);
  std::string text;
  for (const AskedKey& key : all)
    if (key.expected != "a table")
      text += fmt::format("{}\t{}\t{}\n", key.path, key.expected, key.fallback);
  return text;
}

}  // namespace

grainlaw_status grainlaw_material_keys(char* text, size_t* size) {
  if (size == nullptr) return GRAINLAW_NULL_POINTER;
  return api::guarded([&] {
    const std::string keys = all_keys();
    const std::size_t need = keys.size() + 1;
    if (text != nullptr) {
      if (*size < need) return GRAINLAW_BUFFER_TOO_SMALL;
      std::memcpy(text, keys.c_str(), need);
    }
    *size = need;
    return GRAINLAW_OK;
  });
}
