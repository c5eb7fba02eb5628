// Paths of small increments of F, each solved once, and how each increment ended.
#pragma once

#include "app/library.hpp"

#include <functional>
#include <string>
#include <vector>

namespace verification::reach {

enum class Ending {
  direct,         // in one part, friction by return mapping from the committed state
  subincrements,  // the library split it
  advanced,       // by a relaxation that advances the friction history: approximate
  failed          // a recoverable status
};

struct Increment {
  int step = 0;
  double strain = 0;    // axial strain or F12 at its end [-]
  double hardness = 0;  // Pi = largest component of the change of F x kn / (p t) [-]
  Ending ending = Ending::failed;
  grainlaw_status status = GRAINLAW_OK;
  grainlaw_report report = grainlaw_report_default();  // exact tangent included
  double cpu = 0;                                      // exact tangent included [ms]
};

struct Path {
  std::string packing;
  std::string kind;      // "drained", "isochoric" or "shear"
  double stiffness = 0;  // kn / (p t) at the start, of two particles of mean radius [-]
  double friction = 0;   // tan(phi) [-]
  std::vector<Increment> increments;
  std::string gave_up;  // "", or why the path ends early
  double pressure = 1;  // at the end / at the start [-]
};

using Observer = std::function<void(const Increment&)>;

// Drained compression at constant lateral Cauchy stress to `axial` in `steps` steps, led by stress
// control. Where the control had to cut a step, the whole step is solved besides, and counts.
void lead_drained(Path& path, const Material& material, double axial, int steps,
                  const Observer& observe);

// Simple shear at constant area to F12 = `shear` in `steps` steps. A step that fails is taken in
// halves, and counts as failed.
void lead_shear(Path& path, const Material& material, double shear, int steps,
                const Observer& observe);

// How far, and in which increments: of Pi = `hardness`, but at most `largest`.
struct SmallIncrements {
  double hardness = 0.3;   // [-]
  double largest = 0.001;  // [-]
  double strain = 0.02;    // [-]
  int most = 150;          // increments

  [[nodiscard]] double size(double stiffness) const;  // of a component of F [-]
  [[nodiscard]] int steps(double stiffness) const;
};

// Drained compression and simple shear in such increments. One step of Newton per increment keeps
// the lateral stress, without iterations, so that no increment gets larger.
void lead_small_drained(Path& path, const Material& material, const SmallIncrements& limits,
                        const Observer& observe);
void lead_small_shear(Path& path, const Material& material, const SmallIncrements& limits,
                      const Observer& observe);

}  // namespace verification::reach
