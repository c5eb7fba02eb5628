// The sections of the study, each with a table study_drag_NAME.csv; bounds stand in their files.
#pragma once

#include "evidence/studies/drag/setting.hpp"

#include <algorithm>

namespace verification::drag {

struct Study {
  Materials materials;
  int most_packings = 0;  // 0: as many as a section has
  // Jumps are counted with these alone; 0: all.
  int only_dimension = 0;
  double only_stiffness = 0;

  [[nodiscard]] int packings(int usual) const {
    return most_packings > 0 ? std::min(usual, most_packings) : usual;
  }
  [[nodiscard]] bool takes(int dimension, double stiffness) const {
    return (only_dimension == 0 || dimension == only_dimension) &&
           (only_stiffness == 0 || stiffness == only_stiffness);
  }
  [[nodiscard]] const StudyOptions& options() const { return materials.options(); }
};

// Whether answers and the unbalanced force have a limit as steps shrink, and uneven steps agree.
void measure_limit(Study& study);
// How far q / p is from equilibrium's over friction and stiffness.
void measure_bias(Study& study);
// Drained to 10 %: the packings of YADE's curves, and eight of one recipe.
void compare_with_yade(Study& study);
// Secants after a reversal, and cycles of small to large strain.
void measure_stiffness(Study& study);
// Jumps of P along fine lines, and P from two starts.
void count_jumps(Study& study);
// Iterations and cuts of a host with stiff grains, and of one that does not cut.
void lead_stiff(Study& study);
// Expansion until contacts are lost, and back.
void fade(Study& study);
// The shortest and the longest steps, holds, and turns.
void measure_short(Study& study);
// Exact tangents against central differences.
void check_tangents(Study& study);
// Time of one evaluation by its increment.
void measure_cost(Study& study);

}  // namespace verification::drag
