// Load over displacement of the conditions that lead a body.
#include "app/load_figure.hpp"

#include "../temporary_directory.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace verification {
namespace {

class load_figure : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is not there";
  }
  // What the picture says; "" without one.
  std::string text(double top, const std::vector<std::string>& conditions) {
    const CsvTable table{
        {"step", "base_y_displacement", "base_y_force", "top_y_displacement", "top_y_force"},
        {{0, 1}, {0, 0}, {100, 250}, {0, top}, {-100, -250}}};
    if (!draw_load_figure(table, conditions, "N/m", directory_ / "load")) return "";
    std::ostringstream content;
    content << std::ifstream(directory_ / "load.svg").rdbuf();
    return content.str();
  }

  const grainlaw::test::TemporaryDirectory directory_;
};

TEST_F(load_figure, shows_what_moves_and_turns_a_push_round) {
  const std::string pushed = text(-1e-3, {"base_y", "top_y"});
  EXPECT_NE(pushed.find("force, against the axis [kN/m]"), std::string::npos) << pushed;
  EXPECT_NE(pushed.find("top_y"), std::string::npos) << pushed;
  EXPECT_EQ(pushed.find("base_y"), std::string::npos) << pushed;
  const std::string pulled = text(1e-3, {"base_y", "top_y"});
  EXPECT_NE(pulled.find("force [kN/m]"), std::string::npos) << pulled;
}

TEST_F(load_figure, is_none_where_nothing_moves) {
  EXPECT_EQ(text(0, {"base_y", "top_y"}), "");
  EXPECT_EQ(text(-1e-3, {"base_y"}), "");
}

}  // namespace
}  // namespace verification
