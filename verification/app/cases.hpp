// Cases of a scene: `[[case]]` tables merged over the rest of the file.
#pragma once

#include "app/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace verification {

// Scene of every case, named SCENE_CASE: its keys replace those of the rest. Empty without cases,
// since a copied table loses its line numbers. A case with `seeds` = N gives N scenes SCENE_CASE_sK
// with material.packing.seed = K. Throws InputError for a case without a name and for two results
// with one name.
std::vector<toml::table> scene_cases(const SceneFile& file);

// Collects failures of independent runs, for several threads.
class CaseFailures {
 public:
  explicit CaseFailures(std::size_t cases) : failures_(cases) {}

  // Calls run() unless an interrupt is pending. An exception is stored with the number and name of
  // its case. Returns its text, empty without one.
  std::string guard(std::size_t number, const std::string& name, const std::function<void()>& run);

  // Throws the stored failures in the order of the cases, with their names when there are several.
  // It throws ComputationError; InputError when all are of that kind; Interrupted after an
  // interrupt, once the others are printed.
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
