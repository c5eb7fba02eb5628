#include "app/cases.hpp"

#include "app/material.hpp"

namespace verification {

std::vector<toml::table> scene_cases(const SceneFile& file) {
  SceneTable root = file.root();
  const std::string name = root.text_or("name", file.path.stem().string());
  std::vector<toml::table> scenes;
  for (SceneTable& one : root.tables("case")) {
    const std::string case_name = one.text("name");
    toml::table content = file.content;
    content.erase("case");
    merge(content, one.content());
    content.insert_or_assign("name", name + "_" + case_name);
    scenes.push_back(std::move(content));
  }
  return scenes;
}

}  // namespace verification
