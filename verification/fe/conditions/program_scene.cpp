#include "fe/conditions/program_scene.hpp"

#include <fmt/format.h>

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
    if (pair == nullptr || pair->size() != 2 || !(*pair)[0].value<double>() ||
        !(*pair)[1].value<double>())
      table.fail("path", fmt::format("another entry at place {}", points.size() + 1),
                 expected_path);
    points.push_back({*(*pair)[0].value<double>(), *(*pair)[1].value<double>()});
  }
  return points;
}

}  // namespace

Program read_program(SceneTable& table, double duration, Rise rise) {
  if (!table.has("path")) {
    const double end = table.number("value");
    const double start = table.number_or("start", rise == Rise::none ? end : 0);
    return Program::linear(start, end, duration);
  }
  if (table.has("value")) table.fail("value", "both value and path", "one of them");
  const Program program{read_path(table)};
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
