#include "app/output.hpp"

#include "app/library.hpp"
#include "app/text.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <map>
#include <system_error>

namespace verification {
namespace {

constexpr const char* cure = "expected another name or --output, or --force to write over it";

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

void check_kept(const std::vector<std::filesystem::path>& found,
                const std::vector<std::filesystem::path>& inputs) {
  for (const auto& output : found) {
    std::error_code error;
    for (const auto& input : inputs)
      if (std::filesystem::equivalent(input, output, error))
        throw InputError(fmt::format(
            "{}: is read and would be written over{}; {}", input.string(),
            input.lexically_normal() == output.lexically_normal() ? "" : " as " + output.string(),
            cure));
    if (is_of_others(output))
      throw InputError(
          fmt::format("{}: is there, and was not written by grainlaw or was changed since; {}",
                      output.string(), cure));
  }
}

}  // namespace

void Outputs::add(const std::string& owner, const std::string& stem,
                  std::initializer_list<const char*> ends) {
  for (const char* end : ends) outputs_.push_back({stem, owner, end});
}

void Outputs::add_pictures(const std::string& owner, const std::string& stem) {
  add(owner, stem, {".svg", ".png"});
}

void Outputs::add_packing(const std::string& owner, const std::string& stem) {
  add(owner, stem, {"_particles.csv", "_contacts.csv", "_cell.csv"});
}

void Outputs::add_series(const std::string& owner, const std::string& stem,
                         const std::string& end) {
  outputs_.push_back({stem, owner, end, true});
}

void Outputs::check_apart(const std::string& scene) const {
  std::map<std::string, std::string> owners;
  for (const Output& output : outputs_) {
    const std::string file = output.stem + (output.series ? "STEP" : "") + output.end;
    const auto [first, own] = owners.emplace(file, output.owner);
    if (!own && first->second != output.owner)
      throw InputError(
          fmt::format("{}: found two outputs called {}, of {} and of {}, expected names of cases "
                      "that keep them apart",
                      scene, file, first->second, output.owner));
  }
}

std::vector<std::filesystem::path> Outputs::found_in(const std::filesystem::path& directory) const {
  std::vector<std::filesystem::path> found;
  std::error_code error;
  for (const Output& output : outputs_) {
    const auto path = directory / (output.stem + output.end);
    if (!output.series && std::filesystem::symlink_status(path, error).type() !=
                              std::filesystem::file_type::not_found)
      found.push_back(path);
  }
  if (std::none_of(outputs_.begin(), outputs_.end(),
                   [](const Output& output) { return output.series; }))
    return found;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    const std::string name = entry.path().filename().string();
    const auto has = [&](const Output& output) {
      const std::size_t rest = output.stem.size() + output.end.size();
      return output.series && name.size() > rest && name.starts_with(output.stem) &&
             name.ends_with(output.end) &&
             is_number(std::string_view(name).substr(output.stem.size(), name.size() - rest));
    };
    if (std::any_of(outputs_.begin(), outputs_.end(), has)) found.push_back(directory / name);
  }
  return found;
}

void Destination::add_options(CLI::App& command) {
  command.add_option("--output", directory, "directory for the results")->capture_default_str();
  command.add_flag("--force", force,
                   "write over files that are read, and over those that grainlaw has not made");
}

OwnFiles Destination::claim(const Outputs& outputs,
                            const std::vector<std::filesystem::path>& inputs) const {
  if (!force) check_kept(outputs.found_in(directory), inputs);
  return OwnFiles(force ? OwnFiles::Others::write_over : OwnFiles::Others::keep);
}

std::filesystem::path Destination::stem(const std::string& name) const {
  return output_stem(directory, name);
}

std::filesystem::path output_stem(const std::string& directory, const std::string& name) {
  if (!is_file_name(name))
    throw InputError(fmt::format("--name: found \"{}\", expected {}", name, file_name_rule));
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!std::filesystem::is_directory(directory))
    throw InputError(
        fmt::format("--output {}: the directory cannot be made: {}", directory, error.message()));
  return std::filesystem::path(directory) / name;
}

}  // namespace verification
