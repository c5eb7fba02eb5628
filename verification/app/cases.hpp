// Scenes that vary one thing at a time: `[[case]]` tables laid over the rest of the file.
#pragma once

#include "app/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace verification {

// The scene of every case, key by key over the rest and named SCENE_CASE; none without cases, for a
// copy of a table no longer knows its lines. A case with `seeds` = N stands for N of them, SCENE_CASE_sK
// with material.packing.seed = K. Throws InputError for a case without a name and for two results of one.
std::vector<toml::table> scene_cases(const SceneFile& file);

// Runs of which none ends the others. Threads may share it.
class CaseFailures {
 public:
  explicit CaseFailures(std::size_t cases) : failures_(cases) {}

  // Calls run() unless the command has been asked to end; what that throws is kept for the case of
  // this number and name. Returns its text, empty when there was none.
  std::string guard(std::size_t number, const std::string& name, const std::function<void()>& run);

  // Throws what was kept, in the order of the cases and with their names when there are several:
  // ComputationError, InputError when all are of that kind, Interrupted when the command was asked to
  // end, after telling the others.
  void check(const std::string& file) const;

 private:
  enum class Kind { none, computation, input, interrupted };
  struct Failure {
    Kind kind = Kind::none;
    std::string text;
    int signal = 0;
  };
  std::vector<Failure> failures_;
};

}  // namespace verification
