#include "point/laboratory_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

constexpr double most_steps = 1e7;

struct Name {
  std::string_view name;
  TestKind kind;
  double step, end;  // defaults
};
// Defaults: a tenth of strain in a hundred steps; twice the pressure in twenty steps of
// stress-driven tests.
constexpr std::array<Name, 8> names{
    {{"isotropic", TestKind::isotropic, 0.05, 0},
     {"oedometric", TestKind::oedometric, 5e-4, 0.02},
     {"k0", TestKind::k0, 0.05, 0},
     {"drained", TestKind::drained, 1e-3, 0.1},
     {"undrained", TestKind::undrained, 1e-3, 0.1},
     {"constant_p", TestKind::constant_p, 1e-3, 0.1},
     {"shear_constant_volume", TestKind::shear_volume, 1e-3, 0.1},
     {"shear_constant_stress", TestKind::shear_pressure, 1e-3, 0.1}}};

Name read_name(SceneTable& table) {
  std::vector<std::string_view> choices;
  for (const Name& name : names) choices.push_back(name.name);
  const std::string chosen = table.choice_or("test", "", choices);
  return *std::find_if(names.begin(), names.end(),
                       [&](const Name& name) { return name.name == chosen; });
}

void read_stop(SceneTable& table, ElementTest& test) {
  // At constant volume the effective stress can vanish; by default that ends the test.
  if (test.kind == TestKind::undrained || test.kind == TestKind::shear_volume)
    test.stop.liquefied = 0.01;
  if (!table.has("stop")) return;
  SceneTable stop = table.table("stop");
  const auto read = [&](const char* key, std::optional<double>& value) {
    if (stop.has(key)) value = stop.number(key, positive);
  };
  read("strain", test.stop.strain);
  read("q", test.stop.q);
  read("ratio", test.stop.ratio);
  read("p", test.stop.p);
  read("axial_stress", test.stop.axial_stress);
  constexpr Range share{0, 1, false, "a share of the pressure at the start, 0 (never) to 1"};
  test.stop.liquefied = stop.number_or("liquefied", test.stop.liquefied, share);
  stop.close();
}

void read_cycles(SceneTable& table, ElementTest& test) {
  test.cycles = table.integer_or("cycles", 0, 0);
  if (test.led_by_stress()) return;
  if (test.cycles == 0) {
    if (table.has("amplitude"))
      table.fail("amplitude", "a table", "one beside cycles, how many loops");
    return;
  }
  if (!table.has("amplitude"))
    table.fail("amplitude", "nothing", "a table, as { strain = 5e-3 } or { q = 30e3 }");
  SceneTable amplitude = table.table("amplitude");
  test.amplitude_of_q = amplitude.has("q");
  if (test.amplitude_of_q && amplitude.has("strain"))
    amplitude.fail("strain", "a second amplitude beside q", "one of the two");
  test.amplitude = amplitude.number(test.amplitude_of_q ? "q" : "strain", positive);
  if (!test.amplitude_of_q && !(test.amplitude < 0.5))
    amplitude.fail("strain", fmt::format("{:g}", test.amplitude),
                   "a strain below 0.5, 0.01 for 1 %");
  amplitude.close();
}

void read_b(SceneTable& table, ElementTest& test, int dimension) {
  const bool triaxial = test.kind == TestKind::drained || test.kind == TestKind::undrained ||
                        test.kind == TestKind::constant_p;
  if (!triaxial || !table.has("b")) return;
  constexpr Range share{0, 1, false, "(sigma2 - sigma3) / (sigma1 - sigma3), from 0 to 1"};
  test.b = table.number("b", share);
  if (dimension == 2) table.fail("b", "two dimensions", "a material with dimension = 3");
  if (test.cycles > 0 || test.end < 0)
    table.fail("b", "a test that extends", "compression: a strain above 0, without cycles");
}

}  // namespace

int ElementTest::expected_steps() const {
  const auto count = [](double way, double size) {
    return std::max(1, static_cast<int>(std::ceil(way / size - 1e-9)));
  };
  if (led_by_stress()) return count(1, step) * std::max(1, 2 * cycles);
  if (cycles == 0) return count(std::abs(end), step);
  return 4 * cycles * count(amplitude_of_q ? 2 * step : amplitude, step);
}

std::vector<std::pair<std::string, double>> ElementTest::stresses() const {
  std::vector<std::pair<std::string, double>> given;
  if (led_by_stress() && end > 0)
    given.emplace_back(kind == TestKind::isotropic ? "pressure" : "axial_stress", end);
  if (held) given.emplace_back(shear() ? "normal_stress" : "lateral_stress", *held);
  if (amplitude_of_q) given.emplace_back("amplitude.q", amplitude);
  if (stop.q) given.emplace_back("stop.q", *stop.q);
  if (stop.p) given.emplace_back("stop.p", *stop.p);
  if (stop.axial_stress) given.emplace_back("stop.axial_stress", *stop.axial_stress);
  return given;
}

ElementTest read_element_test(SceneTable& table, int dimension) {
  const Name name = read_name(table);
  ElementTest test;
  test.kind = name.kind;
  test.step = name.step;
  test.end = name.end;
  if (test.kind == TestKind::isotropic && table.has("pressure"))
    test.end = table.number("pressure", positive);
  if (test.kind == TestKind::k0 && table.has("axial_stress"))
    test.end = table.number("axial_stress", positive);
  if (!test.led_by_stress()) {
    constexpr Range stretch{-0.5, 0.5, true,
                            "a strain between -0.5 and 0.5, 0.05 for 5 % of compression"};
    test.end = table.number_or("strain", test.end, stretch);
    if (test.end == 0) table.fail("strain", "0", stretch.text);
  }
  if (test.kind == TestKind::drained && table.has("lateral_stress"))
    test.held = table.number("lateral_stress", positive);
  if (test.kind == TestKind::shear_pressure && table.has("normal_stress"))
    test.held = table.number("normal_stress", positive);
  read_cycles(table, test);
  read_b(table, test, dimension);
  if (table.has("step") && table.has("steps"))
    table.fail("step", "a number beside steps", "one of the two");
  if (test.led_by_stress()) {
    test.step = 1.0 / table.integer_or("steps", static_cast<int>(std::lround(1 / test.step)), 1);
  } else {
    constexpr Range size{0, 0.1, true, "a strain of one step, above 0 and up to 0.1"};
    test.step = table.number_or("step", test.step, size);
    // Driving strain of the whole test, or of a quarter cycle.
    const double way =
        test.cycles > 0 && !test.amplitude_of_q ? test.amplitude : std::abs(test.end);
    if (table.has("steps")) test.step = way / table.integer("steps", 1);
    if (test.step < way / most_steps)
      table.fail(table.has("steps") ? "steps" : "step",
                 fmt::format("{:.2g} steps over a strain of {:g}", way / test.step, way),
                 fmt::format("at most {:g}", most_steps));
  }
  read_stop(table, test);
  return test;
}

}  // namespace verification
