#include "fe/conditions/program_scene.hpp"

#include <gtest/gtest.h>

#include <string>

namespace verification {
namespace {

Program parse(const std::string& text, double duration = 1, Rise rise = Rise::from_zero) {
  const toml::table content = toml::parse(text).table();
  SceneTable table(content, "scene.toml", "displacement");
  return read_program(table, duration, rise);
}

TEST(program, a_value_is_reached_linearly_over_the_run) {
  const Program program = parse("value = 3.0", 2);
  EXPECT_DOUBLE_EQ(program.at(0), 0);
  EXPECT_DOUBLE_EQ(program.at(0.5), 0.75);
  EXPECT_DOUBLE_EQ(program.at(2), 3);
}

TEST(program, a_load_without_start_is_constant) {
  const Program program = parse("value = 3.0", 1, Rise::none);
  EXPECT_DOUBLE_EQ(program.at(0), 3);
  EXPECT_DOUBLE_EQ(program.at(0.3), 3);
}

TEST(program, a_path_is_piecewise_linear_and_constant_outside) {
  const Program program = parse("path = [[0.25, 1.0], [0.75, -1.0]]");
  EXPECT_DOUBLE_EQ(program.at(0), 1);
  EXPECT_DOUBLE_EQ(program.at(0.5), 0);
  EXPECT_DOUBLE_EQ(program.at(1), -1);
}

TEST(program, a_half_sine_is_a_pulse_and_a_sine_goes_on) {
  const Program pulse = parse("half_sine = { amplitude = 2.0, period = 0.4, start = 0.1 }");
  EXPECT_DOUBLE_EQ(pulse.at(0.05), 0);
  EXPECT_DOUBLE_EQ(pulse.at(0.2), 2);
  EXPECT_DOUBLE_EQ(pulse.at(0.35), 0);
  const Program sine = parse("sine = { amplitude = 2.0, period = 0.4 }");
  EXPECT_NEAR(sine.at(0.3), -2, 1e-14);
  EXPECT_NEAR(sine.at(0.9), 2, 1e-14);
  EXPECT_EQ(parse("sine = { amplitude = 2.0, period = 0.4, periods = 2 }").at(0.9), 0);
}

TEST(program, a_wrong_pulse_is_refused) {
  EXPECT_THROW(parse("half_sine = { amplitude = 2.0, period = 0.0 }"), InputError);
  EXPECT_THROW(parse("half_sine = { amplitude = 2.0, period = 1.0, periods = 2 }"), InputError);
  EXPECT_THROW(parse("half_sine = { amplitude = 2.0, period = 1.0 }\nvalue = 1.0"), InputError);
  EXPECT_THROW(parse("half_sine = { amplitude = 2.0, period = 1.0 }\npath = [[0.0, 1.0]]"),
               InputError);
  EXPECT_THROW(parse("sine = { period = 1.0 }"), InputError);
}

TEST(program, a_wrong_path_is_refused) {
  EXPECT_THROW(parse("path = []"), InputError);
  EXPECT_THROW(parse("path = 1.0"), InputError);
  EXPECT_THROW(parse("path = [[0.0, 1.0, 2.0]]"), InputError);
  EXPECT_THROW(parse("path = [[0.5, 1.0], [0.5, 2.0]]"), InputError);
  EXPECT_THROW(parse("path = [[0.5, 1.0], [1.5, 2.0]]"), InputError);
  EXPECT_THROW(parse("path = [[0.0, 0.0], [1.0, 2.0]]\nvalue = 1.0"), InputError);
  EXPECT_THROW(parse(""), InputError);
}

}  // namespace
}  // namespace verification
