// Laboratory tests of soils for discs and spheres: the key `test` selects a path. Pressures, q and
// their strains are positive in compression. Axis D, the last, is axial, the others lateral. Shear
// displaces planes of the last axis along axis 1: F12 of discs, F13 of spheres.
#pragma once

#include "app/scene.hpp"
#include "point/driver.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace verification {

enum class TestKind {
  isotropic,       // all normal stresses approach `pressure`
  oedometric,      // axial strain, no lateral strain
  k0,              // like oedometric, driven by the axial stress
  drained,         // axial strain, constant lateral stresses
  undrained,       // axial strain, constant det F, one lateral factor
  constant_p,      // axial strain, constant mean pressure and lateral stress differences
  shear_volume,    // simple shear, other components of F constant
  shear_pressure,  // simple shear, constant normal stress on its planes
};

// Ends of a test, or of a half cycle; an absent value never ends it.
struct TestStop {
  std::optional<double> strain;  // axial or shear strain since the start, absolute [-]
  std::optional<double> q;       // axial less lateral stress, or the shear stress, absolute [Pa]
  std::optional<double> ratio;   // q over mean pressure, absolute [-]
  std::optional<double> p;       // mean pressure, reached from either side [Pa]
  std::optional<double> axial_stress;  // reached from either side [Pa]
  double liquefied = 0;                // share of the initial p below which a soil is liquefied [-]
};

struct ElementTest {
  TestKind kind = TestKind::drained;
  double step = 1e-3;          // strain per step [-]; stress-driven tests: 1 / steps
  double end = 0.1;            // strain [-], or stress [Pa] of isotropic and k0
  std::optional<double> held;  // lateral stress of drained, normal stress of shear_pressure [Pa]
  // (sigma2 - sigma3) / (sigma1 - sigma3) of true triaxial compression: sigma22 between sigma11 and
  // the axial stress [-].
  std::optional<double> b;
  int cycles = 0;               // cycles; 0: monotonic
  bool amplitude_of_q = false;  // cycles reverse at +-q of the start, else at +-strain
  double amplitude = 0;         // [Pa] or [-]
  TestStop stop;

  [[nodiscard]] bool shear() const {
    return kind == TestKind::shear_volume || kind == TestKind::shear_pressure;
  }
  [[nodiscard]] bool led_by_stress() const {
    return kind == TestKind::isotropic || kind == TestKind::k0;
  }
  // Number of steps unless a stop comes first; an estimate for cycles between stresses.
  [[nodiscard]] int expected_steps() const;
  // The stresses that were given, by their keys [Pa].
  [[nodiscard]] std::vector<std::pair<std::string, double>> stresses() const;
};

inline constexpr std::string_view test_names =
    "isotropic, oedometric, k0, drained, undrained, constant_p, shear_constant_volume, "
    "shear_constant_stress";

// Reads a [[segment]] with `test`. Throws InputError.
ElementTest read_element_test(SceneTable& table, int dimension);

// Drives the driver along the test. Throws StepError as PointDriver::run does.
template <int D>
TestEnd run_element_test(PointDriverOf<D>& driver, const ElementTest& test,
                         const PointObserverOf<D>& observe, const CutObserver& observe_cut = {});

}  // namespace verification
