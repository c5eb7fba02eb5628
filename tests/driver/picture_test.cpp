// Pictures as a reader sees them: cycles told apart, q with its sign, maps that stay small files.
#include "app/figure.hpp"
#include "app/history.hpp"
#include "app/packing_map.hpp"
#include "app/stresses.hpp"

#include "../temporary_directory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace verification {
namespace {

class picture : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* program : {"gnuplot", "rsvg-convert"})
      if (std::system((std::string("command -v ") + program + " >/dev/null").c_str()) != 0)
        GTEST_SKIP() << program << " is not there";
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    std::ostringstream content;
    content << std::ifstream(directory_ / (name + ".svg")).rdbuf();
    return content.str();
  }
  // A table of records with so many cycles of the axial strain.
  [[nodiscard]] static CsvTable cyclic(int cycles) {
    CsvTable table;
    for (const std::string& column : record_columns<3>()) {
      table.names.push_back(column.substr(0, column.find('[')));
      std::vector<double> values;
      for (int k = 0; k <= 8 * cycles; ++k)
        values.push_back(std::sin(0.25 * M_PI * k) *
                         (table.names.back() == "axial_strain" ? 1e-3 : 1e4));
      table.columns.push_back(values);
    }
    return table;
  }

  const grainlaw::test::TemporaryDirectory directory_;
};

TEST(cycles, end_at_every_second_turn_and_know_nothing_of_jitter) {
  EXPECT_TRUE(cycles_of({0, 1, 2, 1.98, 3, 4}).empty());
  EXPECT_TRUE(cycles_of({0, 1, 0}).empty());
  EXPECT_TRUE(cycles_of({}).empty());
  EXPECT_EQ(cycles_of({0, 1, 0, -1, 0, 1, 0, -1, 0}),
            (std::vector<int>{1, 1, 1, 1, 2, 2, 2, 2, 2}));
}

TEST(stresses, of_extension_are_a_negative_q) {
  const CsvTable table{{"sigma11", "sigma22", "sigma12"}, {{-2e5}, {-1e5}, {0}}};
  EXPECT_DOUBLE_EQ(stresses_of(table).deviatoric()[0], -100);
  EXPECT_DOUBLE_EQ(stresses_of(table).mean[0], 150);
}

TEST_F(picture, of_cycles_has_a_colour_for_each_and_their_scale) {
  ASSERT_TRUE(draw_history(cyclic(6), axial_abscissa, directory_ / "six"));
  const std::string six = text("six");
  EXPECT_NE(six.find("cycle [-]"), std::string::npos);
  EXPECT_NE(six.find("axial less lateral stress q [kPa]"), std::string::npos);
  ASSERT_TRUE(draw_history(cyclic(1), axial_abscissa, directory_ / "one"));
  EXPECT_EQ(text("one").find("cycle [-]"), std::string::npos);
}

TEST_F(picture, breaks_an_ordinate_that_is_longer_than_its_panel) {
  ASSERT_TRUE(draw_history(cyclic(1), axial_abscissa, directory_ / "one"));
  EXPECT_EQ(text("one").find("volumetric strain, dilation"), std::string::npos);
  EXPECT_NE(text("one").find("dilation + [%]"), std::string::npos);
}

TEST_F(picture, of_a_stress_that_rounding_alone_moves_is_drawn) {
  const Curve path{"", {100.00001774226, 100.00001774226 + 1e-13}, {100, 300}};
  ASSERT_TRUE(
      draw({"", "lateral stress [kPa]", {{"axial stress [kPa]", {path}}}}, directory_ / "x"));
  EXPECT_NE(text("x").find("lateral stress [kPa]"), std::string::npos);
}

// A cell of particles on a grid, each with three contacts.
Snapshot cell_of(int columns, bool spheres) {
  std::mt19937 random(1);
  std::exponential_distribution<double> force(1e-2);
  Snapshot snapshot;
  const double step = 2e-3;
  const int layers = spheres ? columns : 1;
  for (int a = 0; a < columns; ++a)
    for (int b = 0; b < columns; ++b)
      for (int c = 0; c < layers; ++c) {
        snapshot.x.push_back(step * (a + 0.5));
        snapshot.y.push_back(step * (b + 0.5));
        if (spheres) snapshot.z.push_back(step * (c + 0.5));
        snapshot.radius.push_back(0.5 * step);
      }
  const double side = step * columns;
  snapshot.cell = spheres ? std::vector<double>{side, 0, 0, 0, side, 0, 0, 0, side}
                          : std::vector<double>{side, 0, 0, side};
  const auto count = static_cast<int>(snapshot.size());
  for (int p = 0; p < count; ++p)
    for (const double angle : {0.3, 1.5, 2.6})
      snapshot.contacts.push_back(
          {p,
           (p + 1) % count,
           {step * std::cos(angle), step * std::sin(angle), spheres ? step : 0},
           force(random),
           false});
  return snapshot;
}

TEST_F(picture, of_hundreds_of_particles_is_less_than_150_kB) {
  for (const bool spheres : {false, true}) {
    ASSERT_TRUE(draw_snapshots({{"axial strain 1 [%]", cell_of(spheres ? 8 : 20, spheres)}}, 0, "",
                               directory_ / "map"));
    EXPECT_LT(std::filesystem::file_size(directory_ / "map.svg"), 150e3);
    EXPECT_GT(std::filesystem::file_size(directory_ / "map.png"), 10e3);
    EXPECT_NE(text("map").find(" mm<"), std::string::npos);  // the length of a bar
    EXPECT_NE(text("map").find(spheres ? ">z<" : ">y<"), std::string::npos);
    EXPECT_EQ(text("map").find("url(#sphere4)") != std::string::npos, spheres);
  }
}

}  // namespace
}  // namespace verification
