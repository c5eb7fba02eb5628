#include "app/cases.hpp"

#include "app/material.hpp"

#include <fmt/format.h>

namespace verification {

std::vector<toml::table> scene_cases(const SceneFile& file) {
  SceneTable root = file.root();
  const std::string name = root.text_or("name", file.path.stem().string());
  if (root.has("seeds")) root.fail("seeds", "a key of the scene", "one of a [[case]]");
  std::vector<toml::table> scenes;
  for (SceneTable& one : root.tables("case")) {
    const std::string case_name = one.text("name");
    toml::table content = file.content;
    content.erase("case");
    if (const auto path = content["material"].value<std::string>())
      content.insert_or_assign("material", toml::table{{"file", *path}});
    merge(content, one.content());
    content.insert_or_assign("name", name + "_" + case_name);
    const int seeds = one.integer_or("seeds", 0, 0);
    content.erase("seeds");
    if (seeds == 0) scenes.push_back(std::move(content));
    for (int seed = 1; seed <= seeds; ++seed) {
      toml::table seeded = content;
      const toml::table packing{{"packing", toml::table{{"seed", seed}}}};
      merge(seeded, toml::table{{"name", fmt::format("{}_{}_s{}", name, case_name, seed)},
                                {"material", packing}});
      scenes.push_back(std::move(seeded));
    }
  }
  return scenes;
}

}  // namespace verification
