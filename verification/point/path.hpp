// Path of a material point: segments that prescribe each component of F or a stress instead.
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

// Target of one component, reached linearly from its value at the start of the segment.
struct Target {
  Control control = Control::deformation;
  bool increment = true;  // value is added to the start value
  double value = 0;       // default: F does not change
  int other = 0;          // component that is subtracted in a difference
  double share = 0;       // of the way from there to the last component of the diagonal [-]
};

struct ElementTest;

// End of a test.
struct TestEnd {
  std::string text = {};   // reason with its number; "": reached its end
  bool liquefied = false;  // no segment can follow
};

struct Segment {
  std::array<Target, 9> target;  // row by row: 11, 12, 21, 22; of spheres 11, 12, 13, 21, ..., 33
  int steps = 1;
  // Diagonal components of F that follow by one factor. det F stays constant, or reaches `volume`
  // where that is above 0.
  std::array<bool, 3> keeps_volume{};
  double volume = 0;
  std::shared_ptr<const ElementTest> test{};  // present: it decides all of the above

  [[nodiscard]] bool isochoric() const {
    return keeps_volume[0] || keeps_volume[1] || keeps_volume[2];
  }
};

// Reads [[segment]]: a laboratory test with its keys (laboratory_test.hpp), or steps and targets.
//   F11              end value;
//   dF11             increment;
//   P11, sigma11     end value [Pa], tension positive;
//   sigma11          also the name of another component of sigma that it equals;
//   mean_pressure    with one component of F that is "free";
//   isochoric        constant volume.
// A component that is not named keeps its F. Throws InputError, also for probable mistakes: a
// stretch of a half or less, since it is probably a strain; a normal stress in tension unless
// contacts carry it.
std::vector<Segment> read_segments(SceneTable& scene, bool bears_tension, int dimension = 2);

// Drained biaxial compression: F22 changes by `axial` (negative: compression), no shear, sigma11 =
// `lateral`.
Segment drained_segment(double axial, double lateral, int steps);
// Drained triaxial compression of spheres: F33 changes by `axial`, no shear, sigma11 = sigma22 =
// `lateral`.
Segment triaxial_segment(double axial, double lateral, int steps);
// Simple shear: F12 changes by `shear`, other components stay.
Segment shear_segment(double shear, int steps);

}  // namespace verification
