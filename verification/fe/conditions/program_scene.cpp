#include "fe/conditions/program_scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace verification {
namespace {

constexpr const char* expected_path = "a list of [time, value] with increasing times";

std::vector<std::array<double, 2>> read_path(SceneTable& table) {
  const toml::node* node = table.node("path");
  if (!node->is_array() || node->as_array()->empty())
    table.fail("path", "something else or nothing", expected_path);
  std::vector<std::array<double, 2>> points;
  for (const toml::node& entry : *node->as_array()) {
    const toml::array* pair = entry.as_array();
    const auto number = [&](std::size_t k) {
      return std::isfinite((*pair)[k].value<double>().value_or(NAN));
    };
    if (pair == nullptr || pair->size() != 2 || !number(0) || !number(1))
      table.fail("path", fmt::format("another entry at place {}", points.size() + 1),
                 expected_path);
    points.push_back({*(*pair)[0].value<double>(), *(*pair)[1].value<double>()});
  }
  return points;
}

Program read_sine(SceneTable table, bool half) {
  Program program{{{0, 0}}, {}};
  program.sine.amplitude = table.number("amplitude");
  program.sine.period = table.number("period", positive);
  program.sine.start = table.number_or("start", 0, not_negative);
  if (!half)
    program.sine.periods =
        table.number_or("periods", std::numeric_limits<double>::infinity(), positive);
  table.close();
  return program;
}

}  // namespace

Program read_program(SceneTable& table, double duration, Rise rise) {
  std::string_view kind = "value";
  for (const std::string_view key : {"path", "sine", "half_sine"}) {
    if (!table.has(key)) continue;
    if (table.has(kind)) table.fail(kind, fmt::format("both {} and {}", kind, key), "one of them");
    kind = key;
  }
  if (kind == "sine" || kind == "half_sine")
    return read_sine(table.table(kind), kind == "half_sine");
  if (kind == "value") {
    const double end = table.number("value");
    const double start = table.number_or("start", rise == Rise::none ? end : 0);
    return Program::linear(start, end, duration);
  }
  const Program program{read_path(table), {}};
  for (std::size_t k = 0; k < program.points.size(); ++k) {
    const double time = program.points[k][0];
    if (time < 0 || time > duration)
      table.fail("path", fmt::format("time {}", time),
                 fmt::format("times from 0 to {}, the run's duration", duration));
    if (k > 0 && time <= program.points[k - 1][0])
      table.fail("path", fmt::format("time {} after {}", time, program.points[k - 1][0]),
                 expected_path);
  }
  return program;
}

}  // namespace verification
