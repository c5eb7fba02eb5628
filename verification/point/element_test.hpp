// Element tests of soils: one key `test` leads discs and spheres along the path that a laboratory has.
// Pressures, q and strains of them are positive in compression. Axis D, the last, is the axial one; the
// others are lateral. A shear moves the last plane along axis 1: F12 of discs, F13 of spheres.
#pragma once

#include "app/scene.hpp"
#include "point/driver.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace verification {

enum class TestKind {
  isotropic,       // all normal stresses lead to `pressure`
  oedometric,      // axial strain, no lateral strain
  k0,              // the same, led by the axial stress
  drained,         // axial strain, lateral stresses stay
  undrained,       // axial strain, det F stays, lateral stretches by one factor
  constant_p,      // axial strain, mean pressure and differences of lateral stresses stay
  shear_volume,    // simple shear, all else stays
  shear_pressure,  // simple shear, the normal stress on its planes stays
};

// Where a test, or a leg of its loops, ends; what is not there never ends it.
struct TestStop {
  std::optional<double> strain;  // axial, or shear, since the start of the test, absolute [-]
  std::optional<double> q;  // axial less lateral stress, of a shear the shear stress, absolute [Pa]
  std::optional<double> ratio;         // q over mean pressure, absolute [-]
  std::optional<double> p;             // mean pressure, reached from either side [Pa]
  std::optional<double> axial_stress;  // reached from either side [Pa]
  double liquefied = 0;  // share of p at the start below which there is no soil any more [-]
};

struct ElementTest {
  TestKind kind = TestKind::drained;
  double step = 1e-3;          // strain of a step [-]; of stress-led tests 1 / steps of the way
  double end = 0.1;            // strain [-], or stress [Pa] of isotropic and k0
  std::optional<double> held;  // lateral stress of drained, normal stress of shear_pressure [Pa]
  // (sigma2 - sigma3) / (sigma1 - sigma3) of true triaxial compression: sigma22 between sigma11 and the
  // axial stress [-].
  std::optional<double> b;
  int cycles = 0;               // loops; 0: one way
  bool amplitude_of_q = false;  // loops turn at +-q of the start, else at +-strain
  double amplitude = 0;         // [Pa] or [-]
  TestStop stop;

  [[nodiscard]] bool shear() const {
    return kind == TestKind::shear_volume || kind == TestKind::shear_pressure;
  }
  [[nodiscard]] bool led_by_stress() const {
    return kind == TestKind::isotropic || kind == TestKind::k0;
  }
  // Steps that it takes where nothing stops it; of loops between stresses a guess.
  [[nodiscard]] int expected_steps() const;
};

inline constexpr std::string_view test_names =
    "isotropic, oedometric, k0, drained, undrained, constant_p, shear_constant_volume, "
    "shear_constant_stress";

// The keys of a [[segment]] with `test`. Throws InputError.
ElementTest read_element_test(SceneTable& table, int dimension);

// Leads the driver along it. Throws StepError as PointDriver::run does.
template <int D>
TestEnd run_element_test(PointDriverOf<D>& driver, const ElementTest& test,
                         const PointObserverOf<D>& observe, const CutObserver& observe_cut = {});

}  // namespace verification
