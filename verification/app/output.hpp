// Output files of commands, and their directory.
#pragma once

#include "app/own_files.hpp"

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace verification {

// The files that a command may write, each with its owner.
class Outputs {
 public:
  void add(const std::string& owner, const std::string& stem,
           std::initializer_list<const char*> ends);
  void add_pictures(const std::string& owner, const std::string& stem);  // stem.svg, stem.png
  void add_packing(const std::string& owner, const std::string& stem);   // as the library writes it
  // stem, a number, and the end.
  void add_series(const std::string& owner, const std::string& stem, const std::string& end);

  // Throws InputError for two of one name and not of one owner: the second would take the place of
  // the first.
  void check_apart(const std::string& scene) const;
  // Those that are in the directory.
  [[nodiscard]] std::vector<std::filesystem::path> found_in(
      const std::filesystem::path& directory) const;

 private:
  struct Output {
    std::string stem, owner, end;
    bool series = false;
  };
  std::vector<Output> outputs_;
};

struct Destination {
  std::string directory = ".";
  bool force = false;  // write over files that are read, and over those of others

  // --output and --force.
  void add_options(CLI::App& command);
  // To be called before any work, and kept until its end. Without --force it throws InputError when an
  // output would take the place of an input or of a file that the command has not made.
  [[nodiscard]] OwnFiles claim(const Outputs& outputs,
                               const std::vector<std::filesystem::path>& inputs) const;
  [[nodiscard]] std::filesystem::path stem(const std::string& name) const;  // output_stem()
};

// Path directory / name without an extension; creates the directory. Throws InputError when it
// cannot, and for a name that leads elsewhere (is_file_name). Names in scenes are checked earlier,
// at their line.
std::filesystem::path output_stem(const std::string& directory, const std::string& name);

}  // namespace verification
