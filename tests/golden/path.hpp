// One representative volume on its way, and a hash of all bits of every answer on it.
#pragma once

#include <grainlaw/grainlaw.hpp>

#include <functional>
#include <string>
#include <vector>

namespace grainlaw::golden {

struct Answer {
  std::string path;
  std::string text;  // place in it, hash, and P for a person
};

using Tensor = std::vector<double>;  // row-major, as F and P of the C ABI

class Path {
 public:
  Path(std::string name, const std::string& toml, std::vector<Answer>& answers);

  void go_to(const Tensor& F, unsigned want = GRAINLAW_WANT_TANGENT_EXACT);
  void try_out(const Tensor& F, unsigned want = GRAINLAW_WANT_TANGENT_EXACT);
  void revert() { state_.revert(); }
  void set_time_step(double step) { state_.set_time_step(step); }

 private:
  void hash_state();
  void record(const std::string& text);

  std::string name_;
  State state_;
  std::vector<Answer>& answers_;
  bool found_ = false;
  int step_ = 0;
};

// A family of paths: `on` begins one from its name and material, and leads it.
using Lead = std::function<void(Path&)>;
using On = std::function<void(const char* name, const std::string& toml, const Lead& lead)>;
void lead_plane_paths(const On& on);
void lead_space_paths(const On& on);
void lead_drag_paths(const On& on);

inline std::string solver(const std::string& keys) { return "[solver]\n" + keys + "\n"; }

// Discs and spheres that several families lead.
extern const std::string made_discs;
extern const std::string sand;
extern const std::string made_spheres;
extern const std::string rolling_sand_of_spheres;

}  // namespace grainlaw::golden
