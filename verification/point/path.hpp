// The way of a material point: segments in which every component of F or of a stress is prescribed.
#pragma once

#include "app/scene.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace verification {

enum class Control {
  deformation,  // a component of F [-]
  piola,        // the component of P of the same indices [Pa]; F there is unknown
  cauchy,       // the component of sigma of the same indices [Pa]; F there is unknown
  mean,         // tr sigma / D [Pa]; F there is unknown
  difference  // the component of sigma less one between `other` and the last [Pa]; F there is unknown
};

// What one component is led to, linearly from its value at the start of the segment.
struct Target {
  Control control = Control::deformation;
  bool increment = true;  // value is added to the start value, not the end value itself
  double value = 0;       // default: F stays as it is
  int other = 0;          // the component that a difference is from
  double share = 0;       // of the way from there to the last component of the diagonal [-]
};

struct ElementTest;

// How a test ended.
struct TestEnd {
  std::string text = {};   // "" : at its end; else what stopped it, with the number
  bool liquefied = false;  // then nothing can follow
};

struct Segment {
  std::array<Target, 9> target;  // row by row: 11, 12, 21, 22; of spheres 11, 12, 13, 21, ..., 33
  int steps = 1;
  // Components of the diagonal of F that follow, by one factor, so that det F stays what it is at the
  // start of the segment, or is `volume` where that is above 0.
  std::array<bool, 3> keeps_volume{};
  double volume = 0;
  std::shared_ptr<const ElementTest> test{};  // then all of the above is of the test

  [[nodiscard]] bool isochoric() const {
    return keeps_volume[0] || keeps_volume[1] || keeps_volume[2];
  }
};

// [[segment]]: a test with its keys (element_test.hpp), or steps, per component one of F11 (end value),
// dF11 (increment), P11, sigma11 (end value, Pa, tension positive; or the name of another component of
// sigma that it equals), mean_pressure beside one F that is "free", and isochoric. A component that is not named keeps its F. Throws
// InputError, also for what cannot be meant: half of the length or less, as when a strain stands for a
// stretch, and a normal stress in tension unless the contacts carry it.
std::vector<Segment> read_segments(SceneTable& scene, bool carries_tension, int dimension = 2);

// Drained biaxial compression: F22 by `axial` (negative: compression), no shear, sigma11 =
// `lateral`.
Segment drained_segment(double axial, double lateral, int steps);
// Drained triaxial compression of spheres: F33 by `axial`, no shear, sigma11 = sigma22 = `lateral`.
Segment triaxial_segment(double axial, double lateral, int steps);
// Simple shear: F12 by `shear`, everything else fixed.
Segment shear_segment(double shear, int steps);

}  // namespace verification
