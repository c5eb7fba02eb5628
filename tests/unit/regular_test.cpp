#include "generate/regular.hpp"

#include "base/error.hpp"
#include "generate/compaction.hpp"
#include "packing/neighbours.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainlaw::core {
namespace {

GeneratorOptions published(GeneratorKind kind, std::size_t columns, std::size_t rows) {
  GeneratorOptions options;
  options.kind = kind;
  options.columns = columns;
  options.rows = rows;
  options.radius_max = 1.02e-3;
  options.overlap = 0.04e-3;
  options.thickness = 1e-3;
  return options;
}

ContactLaw soft_law() {
  ContactLaw law;
  law.normal_stiffness = 1e4;
  law.ratio = 0.2;
  law.friction = 0.4;
  return law;
}

std::size_t touching(const Packing& packing) {
  std::vector<NeighbourPair<2>> pairs;
  NeighbourSearch<2>().find(packing.size(), packing.position.data(), packing.radius.data(),
                            packing.cell.data(), 0, pairs);
  return pairs.size();
}

TEST(regular, every_disc_touches_four_or_six) {
  for (const std::size_t columns : {2U, 3U, 4U, 9U})
    for (const std::size_t rows : {2U, 4U, 8U}) {
      EXPECT_EQ(touching(square_lattice(columns, rows, 1.02, 2)), 2 * columns * rows);
      EXPECT_EQ(touching(hexagonal_lattice(columns, rows, 1.02, 2)), 3 * columns * rows);
    }
}

// Liu, Bosco & Suiker (2017), section 4.1: 25, 100, 225 discs, V = 64, 324, 784 mm2, and the four
// corner discs are the corners of the frame.
TEST(regular, square_frames_are_the_published_ones) {
  for (const std::size_t side : {5U, 10U, 15U}) {
    const auto material = test::make_material(test::describe(
        consolidate(published(GeneratorKind::square, side - 1, side - 1), soft_law()), soft_law(),
        BoundaryType::frame_p));
    const Packing& packing = material->packing;
    EXPECT_EQ(packing.size(), side * side);
    EXPECT_EQ(packing.frame->boundary.size(), 4 * (side - 1));
    const double length = 2e-3 * static_cast<double>(side - 1);
    EXPECT_NEAR(polygon_area(packing), length * length, 1e-12);
    double low = 1;
    double high = 0;
    for (std::size_t p = 0; p < packing.size(); ++p) {
      low = std::min(low, packing.position[p]);
      high = std::max(high, packing.position[p]);
    }
    EXPECT_NEAR(high - low, length, 1e-12);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto corner = static_cast<std::size_t>(packing.frame->corner[k]);
      EXPECT_NEAR(packing.position[corner], k == 0 || k == 3 ? low : high, 1e-12);
    }
    for (const auto& area : packing.frame->area) EXPECT_GT(std::hypot(area[0], area[1]), 1e-3);
  }
}

TEST(regular, hexagonal_frames_close) {
  const auto material = test::make_material(
      test::describe(consolidate(published(GeneratorKind::hexagonal, 5, 4), soft_law()), soft_law(),
                     BoundaryType::frame_p));
  EXPECT_EQ(material->packing.size(), 30U);
}

TEST(regular, stress_at_rest_is_the_pressure_wanted) {
  for (const GeneratorKind kind : {GeneratorKind::square, GeneratorKind::hexagonal})
    for (const double pressure : {1e2, 1e4, 1e6}) {
      GeneratorOptions options = published(kind, 4, 4);
      options.overlap.reset();
      options.pressure = pressure;
      const auto material =
          test::make_material(test::describe(consolidate(options, soft_law()), soft_law()));
      const auto& stress = material->initial.stress;
      EXPECT_NEAR(stress[0] / pressure, -1, 1e-9);
      EXPECT_NEAR(stress[3] / pressure, -1, 1e-9);
      EXPECT_NEAR(stress[1] / pressure, 0, 1e-9);
    }
}

TEST(regular, refuses_what_cannot_be) {
  const auto refused = [](auto change) {
    GeneratorOptions options = published(GeneratorKind::hexagonal, 4, 4);
    change(options);
    EXPECT_THROW(consolidate(options, soft_law()), Error);
  };
  refused([](auto& o) { o.columns = 1; });
  refused([](auto& o) { o.rows = 0; });
  refused([](auto& o) { o.rows = 3; });
  refused([](auto& o) { o.radius_max = -1; });
  refused([](auto& o) { o.overlap = 1e-3; });
  refused([](auto& o) { o.overlap = -1e-9; });
  refused([](auto& o) { o.overlap.reset(), o.pressure = 1e8; });
  refused([](auto& o) { o.overlap.reset(), o.pressure = NAN; });
}

}  // namespace
}  // namespace grainlaw::core
