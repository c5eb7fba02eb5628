#include "app/cases.hpp"

#include "app/interrupt.hpp"
#include "app/library.hpp"
#include "app/material.hpp"
#include "app/progress.hpp"
#include "app/text.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <utility>

namespace verification {
namespace {

// Turns the path of a material file into a table, so that keys can be merged into it.
void as_table(toml::table& scene) {
  if (const auto path = scene["material"].value<std::string>())
    scene.insert_or_assign("material", toml::table{{"file", *path}});
}

}  // namespace

std::vector<toml::table> scene_cases(const SceneFile& file) {
  SceneTable root = file.root();
  const std::string name = root.file_name_or("name", file.path.stem().string());
  if (root.has("seeds")) root.fail("seeds", "a key of the scene", "one of a [[case]]");
  std::set<std::string> names;
  std::map<std::string, std::string> owners;  // result name -> case
  std::vector<toml::table> scenes;
  for (SceneTable& one : root.tables("case")) {
    const std::string case_name = one.file_name("name");
    if (!names.insert(case_name).second)
      one.fail("name", '"' + case_name + '"', "a name that no other case has");
    toml::table content = file.content;
    content.erase("case");
    as_table(content);
    merge(content, one.content());
    as_table(content);
    const int seeds = one.integer_or("seeds", 0, 0);
    content.erase("seeds");
    const auto add = [&](toml::table scene, const std::string& result) {
      const auto [owner, own] = owners.emplace(result, case_name);
      if (!own)
        one.fail(
            "name",
            fmt::format("\"{}\" with results {} as of \"{}\"", case_name, result, owner->second),
            "results that no other case has");
      scene.insert_or_assign("name", result);
      scenes.push_back(std::move(scene));
    };
    if (seeds == 0) add(std::move(content), name + "_" + case_name);
    for (int seed = 1; seed <= seeds; ++seed) {
      toml::table seeded = content;
      const toml::table packing{{"packing", toml::table{{"seed", seed}}}};
      merge(seeded, toml::table{{"material", packing}});
      add(std::move(seeded), fmt::format("{}_{}_s{}", name, case_name, seed));
    }
  }
  return scenes;
}

std::string CaseFailures::guard(std::size_t number, const std::string& name,
                                const std::function<void()>& run) {
  Failure& failure = failures_[number];
  const std::string prefix = failures_.size() > 1 ? name + ": " : "";
  try {
    Interrupt::check();
    run();
    return {};
  } catch (const Interrupted& stop) {
    failure = {Kind::interrupted, stop.text(), stop.signal};
    return failure.text;
  } catch (const InputError& error) {
    failure = {Kind::input, prefix + error.what()};
    return error.what();
  } catch (const std::exception& error) {
    failure = {Kind::computation, prefix + error.what()};
    return error.what();
  }
}

void CaseFailures::check(const std::string& file) const {
  std::string text;
  int signal = 0;
  bool input = true;
  for (const Failure& failure : failures_) {
    if (failure.kind == Kind::interrupted) signal = failure.signal;
    if (failure.kind == Kind::none || failure.kind == Kind::interrupted) continue;
    input = input && failure.kind == Kind::input;
    // A message that begins with the file needs no case name.
    const bool named = failures_.size() == 1 && failure.text.starts_with(file + ":");
    text += (text.empty() ? (named ? "" : file + ": ") : "\n  ") + failure.text;
  }
  if (signal != 0) {
    if (!text.empty()) tell("grainlaw: " + terminal_text(text) + "\n");
    throw Interrupted{signal};
  }
  if (text.empty()) return;
  if (input) throw InputError(text);
  throw ComputationError(text);
}

}  // namespace verification
