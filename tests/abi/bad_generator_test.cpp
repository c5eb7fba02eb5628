// Generators with mistakes: refused with file, line and key, or with what cannot be.
#include "support.hpp"

#include <string>

namespace grainlaw::test {
namespace {

const std::string contact =
    "[contact]\nlaw = \"frictional\"\nkn = 1e4\nratio = 0.2\nfriction = 0.4\n";

std::string grown(const std::string& lines) {
  return "dimension = 2\nthickness = 1e-3\n[packing]\ngenerator = \"lubachevsky-stillinger\"\n" +
         lines + contact;
}

std::string square(const std::string& lines) {
  return "dimension = 2\nthickness = 1e-3\n[packing]\ngenerator = \"square\"\n" + lines + contact;
}

std::string hexagonal(const std::string& lines) {
  std::string text = square(lines);
  return text.replace(text.find("square"), 6, "hexagonal");
}

void expect_told(const std::string& text, grainlaw_status status, const std::string& first,
                 const std::string& second = "") {
  char message[1024];
  grainlaw_material* made = nullptr;
  expect_refused(grainlaw_material_parse(text.c_str(), "here", &made, message, sizeof message),
                 status, first);
  EXPECT_EQ(made, nullptr);
  EXPECT_NE(std::string(message).find(first), std::string::npos) << message << "\nfor " << first;
  EXPECT_NE(std::string(message).find(second), std::string::npos) << message << "\nfor " << second;
}

const std::string ten = "count = 10\nradii = [1e-3, 2e-3]\nseed = 1\n";
const std::string lattice = "columns = 4\nrows = 4\nradius = 1e-3\n";

TEST(bad_generator, keys_of_growth_are_checked) {
  const auto told = [](const std::string& lines, const std::string& place,
                       const std::string& expected) {
    expect_told(grown(lines), GRAINLAW_BAD_MATERIAL, "here:" + place, expected);
  };
  const std::string good = ten + "pressure = 1e4\n";
  told(good + "growth_rate = 0\n", "9: packing.growth_rate", "from 1e-05 to 1");
  told(good + "growth_rate = \"a\"\n", "9: packing.growth_rate", "a number");
  told(good + "volume_fraction = 0.99\n", "9: packing.volume_fraction", "from 0.4 to 0.95");
  told(good + "volume_fraction = 0.3\n", "9: packing.volume_fraction", "from 0.4 to 0.95");
  told(good + "columns = 3\n", "9: packing.columns", "found an unknown key");
  told(good + "friction = nan\n", "9: packing.friction", "a number >= 0");
  told(good + "anisotropy = -0.1\nfriction = 0.4\n", "9: packing.anisotropy", "from 0 to 0.5");
  told(good + "anisotropy = 0.1\n", "3: packing.friction", "needs shear strength");
  told(good + "anisotropy_direction = 45\n", "3: packing.anisotropy", "anisotropy_direction");
  told(good + "friction = 0.4\nanisotropy = 0.1\nanisotropy_direction = 200\n",
       "11: packing.anisotropy_direction", "from -180 to 180");
  told(ten + "pressure = 1e4\nvoid_ratio = 0.2\nfriction = 0.1\n", "10: packing.friction",
       "none beside pressure and void_ratio together");
  told(ten + "pressure = 1e4\nvoid_ratio = 0.2\nanisotropy = 0.1\n", "10: packing.anisotropy",
       "none beside pressure and void_ratio together");
  told("count = 0\nradii = [1e-3, 2e-3]\nseed = 1\npressure = 1e4\n", "5: packing.count",
       "an integer from 2");
  told("count = 10\nradii = [1e-3, 2e-3]\nseed = 0.5\npressure = 1e4\n", "7: packing.seed",
       "an integer >= 0");
}

TEST(bad_generator, keys_of_lattices_are_checked) {
  const auto told = [](const std::string& text, const std::string& place,
                       const std::string& expected) {
    expect_told(text, GRAINLAW_BAD_MATERIAL, "here:" + place, expected);
  };
  told(square("rows = 4\nradius = 1e-3\npressure = 1e4\n"), "3: packing.columns", "found nothing");
  told(square("columns = 1\nrows = 4\nradius = 1e-3\npressure = 1e4\n"), "5: packing.columns",
       "from 2 to 10000");
  told(square("columns = 4\nrows = 2.5\nradius = 1e-3\npressure = 1e4\n"), "6: packing.rows",
       "from 2 to 10000");
  told(square("columns = 4\nrows = 4\nradius = 0\npressure = 1e4\n"), "7: packing.radius",
       "a number > 0");
  told(square(lattice), "3: packing.pressure", "either pressure or overlap");
  told(square(lattice + "pressure = 1e4\noverlap = 1e-5\n"), "9: packing.overlap", "found both");
  told(square(lattice + "overlap = 1e-3\n"), "8: packing.overlap", "from 0 to 0.0005");
  told(square(lattice + "pressure = 1e4\nseed = 1\n"), "9: packing.seed", "found an unknown key");
  told(square(lattice + "pressure = 1e4\nvoid_ratio = 1\n"), "9: packing.void_ratio",
       "found an unknown key");
  told(hexagonal("columns = 4\nrows = 3\nradius = 1e-3\npressure = 1e4\n"), "6: packing.rows",
       "an even number of rows");
}

TEST(bad_generator, overlaps_that_drown_in_rounding_are_told) {
  expect_told(square(lattice + "overlap = 1e-16\n"), GRAINLAW_NOT_CONVERGED,
              "contacts carry no more at F = I than rounding makes of them",
              "stiff: expected softer");
}

TEST(bad_generator, friction_that_the_material_lacks_is_told) {
  expect_told(
      "dimension = 2\nthickness = 0.1\n[packing]\ngenerator = \"compaction\"\ncount = 60\nseed = "
      "4\n"
      "radii = [2e-3, 4e-3]\npressure = 1e5\nfriction = 3\n[contact]\nlaw = \"frictional\"\n"
      "young = 6e8\nratio = 0.8\nfriction = 0.1\n",
      GRAINLAW_NOT_CONVERGED, "made with packing.friction = 3, which contact.friction = 0.1");
}

TEST(bad_generator, a_pressure_beyond_all_packings_is_told_with_the_largest) {
  expect_told(square(lattice + "pressure = 1e9\n"), GRAINLAW_BAD_PACKING, "pressure = 1000000000",
              "at most 2e+06 Pa");
  expect_told(grown(ten + "pressure = 1e9\n"), GRAINLAW_BAD_PACKING, "pressure = 1000000000",
              "at most 2e+06 Pa");
}

TEST(bad_generator, a_pressure_below_rounding_is_told_with_the_least) {
  expect_told(square(lattice + "pressure = 9e-4\n"), GRAINLAW_BAD_PACKING, "pressure = 0.0009",
              "at least 0.001 Pa");
  expect_told(grown(ten + "pressure = 1e-300\n"), GRAINLAW_BAD_PACKING, "pressure = 1e-300",
              "at least 0.001 Pa");
}

TEST(bad_generator, growth_beyond_jamming_is_told_with_where_it_jams) {
  expect_told(grown(ten + "pressure = 1e4\nvolume_fraction = 0.94\n"), GRAINLAW_BAD_PACKING,
              "the discs jam at a volume fraction of 0.", "volume_fraction = 0.94");
}

TEST(bad_generator, a_void_ratio_without_load_is_told) {
  expect_told(grown(ten + "void_ratio = 0.5\n"), GRAINLAW_BAD_PACKING, "void_ratio = 0.5",
              "expected a lower one");
}

}  // namespace
}  // namespace grainlaw::test
