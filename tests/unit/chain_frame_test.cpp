// Frames whose opposite sides are not copies: regular packings with a closed chain around them.
#include "../temporary_directory.hpp"
#include "base/error.hpp"
#include "boundary_support.hpp"
#include "frame/frame_geometry.hpp"
#include "state/output.hpp"

namespace grainlaw::core::test {
namespace {

constexpr double radius = 0.5e-3;
constexpr double squeeze = 1e-3;  // overlap / diameter

// n x n discs, every other row shifted by `shift` diameters, rows `rise` diameters apart.
Packing regular(std::size_t n, double shift, double rise) {
  const double d = 2 * radius * (1 - squeeze);
  Packing packing;
  packing.thickness = 1e-3;
  packing.radius.assign(n * n, radius);
  packing.position.resize(2 * n * n);
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t k = 0; k < n; ++k) {
      packing.position[row * n + k] = d * (static_cast<double>(k) + (row % 2 == 1 ? shift : 0));
      packing.position[n * n + row * n + k] = d * rise * static_cast<double>(row);
    }
  }
  const double length = d * static_cast<double>(n - 1);
  packing.cell = {length, 0, 0, length * rise};
  Frame frame;
  frame.copies = {false, false};
  const auto id = [n](std::size_t row, std::size_t k) { return static_cast<int>(row * n + k); };
  for (std::size_t k = 0; k < n; ++k) frame.boundary.push_back(id(0, k));
  for (std::size_t k = 1; k < n; ++k) frame.boundary.push_back(id(k, n - 1));
  for (std::size_t k = n - 1; k-- > 0;) frame.boundary.push_back(id(n - 1, k));
  for (std::size_t k = n - 1; k-- > 1;) frame.boundary.push_back(id(k, 0));
  frame.corner = {id(0, 0), id(0, n - 1), id(n - 1, n - 1), id(n - 1, 0)};
  packing.frame = frame;
  complete_frame(packing);
  return packing;
}

Packing square(std::size_t n) { return regular(n, 0, 1); }
Packing hexagonal(std::size_t n) { return regular(n, 0.5, std::sqrt(0.75)); }

ContactLaw paper_law() {  // Liu, Bosco & Suiker (2017), Table 4
  ContactLaw law;
  law.normal_stiffness = 1e4;
  law.ratio = 0.2;
  law.friction = 0.4;
  return law;
}

Packing through_files(const Packing& packing) {
  const TemporaryDirectory directory;
  const std::string prefix = directory / "chain";
  write_packing(prefix, packing);
  return read_packing({prefix + "_particles.csv", "", prefix + "_cell.csv"});
}

TEST(chain_frame, averages_to_the_deformation) {
  for (const std::size_t n : {5U, 10U, 15U}) {
    for (const auto& packing : {square(n), hexagonal(n)}) {
      const double area = polygon_area(packing);
      Tensor mean{};
      for (std::size_t q = 0; q < packing.frame->boundary.size(); ++q) {
        const auto p = static_cast<std::size_t>(packing.frame->boundary[q]);
        for (std::size_t k = 0; k < 4; ++k) {
          mean[k] +=
              packing.position[k / 2 * packing.size() + p] * packing.frame->area[q][k % 2] / area;
        }
      }
      EXPECT_LE(relative_difference(mean, identity), 1e-13);
    }
  }
}

TEST(chain_frame, comes_back_from_files) {
  const Packing packing = hexagonal(5);
  const Packing back = through_files(packing);
  ASSERT_TRUE(back.frame);
  EXPECT_EQ(back.frame->copies, (std::array{false, false}));
  EXPECT_EQ(back.frame->boundary, packing.frame->boundary);
  EXPECT_EQ(back.frame->corner, packing.frame->corner);
  EXPECT_EQ(back.position, packing.position);
}

TEST(chain_frame, carries_every_condition_without_copies) {
  for (const std::size_t n : {5U, 10U, 15U}) {
    for (const auto type : {BoundaryType::frame_d, BoundaryType::frame_t}) {
      SCOPED_TRACE(std::to_string(n) + (type == BoundaryType::frame_d ? " D" : " T"));
      State state(make_material(describe(through_files(hexagonal(n)), paper_law(), type, 1e-8)));
      const Tensor F{0.9999, 5e-5, 5e-5, 0.9999};
      const auto result = advance(state, F);
      EXPECT_LT(result.stress[0], 0);
      EXPECT_LE(relative_difference(average_deformation(state), F), 1e-12);
      EXPECT_LE(relative_difference(stress_of_boundary(state), result.stress), 1e-6);
    }
  }
}

TEST(chain_frame, homogeneous_is_not_softer_than_uniform_stress) {
  double work[2]{};
  const Tensor F{0.9997, 1e-4, 1e-4, 0.9997};
  for (const std::size_t k : {0U, 1U}) {
    const auto type = k == 0 ? BoundaryType::frame_d : BoundaryType::frame_t;
    State state(make_material(describe(hexagonal(10), paper_law(), type, 1e-8)));
    const Tensor start = stress_of(state);
    advance(state, F, 3);
    work[k] = dot(sum(stress_of(state), -1, start), sum(F, -1, identity));
  }
  EXPECT_GT(work[0], work[1]);
  EXPECT_GT(work[1], 0);
}

TEST(chain_frame, does_not_carry_periodic_sides) {
  EXPECT_THROW(make_material(describe(square(5), paper_law(), BoundaryType::frame_p)), Error);
}

TEST(chain_frame, of_a_square_packing_with_copies_carries_periodic_sides) {
  Packing packing = square(5);
  packing.frame->copies = {true, true};
  complete_frame(packing);
  State state(make_material(describe(packing, paper_law(), BoundaryType::frame_p, 1e-8)));
  const auto result = advance(state, {0.9999, 2e-5, 2e-5, 0.9999});
  // Rows of springs kn along both axes, a row per spacing, at overlap squeeze + 1e-4 diameters.
  const double d = 2 * radius * (1 - squeeze);
  const double force = 1e4 * (2 * radius - 0.9999 * d);
  EXPECT_NEAR(result.stress[0], -force / (d * packing.thickness),
              1e-3 * std::abs(result.stress[0]));
}

TEST(chain_frame, copied_to_left_and_right_alone_carries_a_layer) {
  Packing packing = square(5);
  packing.frame->copies = {true, false};
  complete_frame(packing);
  packing = through_files(packing);
  EXPECT_EQ(packing.frame->copies, (std::array{true, false}));
  auto description = describe(packing, paper_law(), BoundaryType::mixed, 1e-8);
  description.boundary.sides = layer_sides();
  EXPECT_LT(
      advance(*std::make_unique<State>(make_material(description)), {1, 1e-5, 0, 0.9999}).stress[3],
      0);
  description.boundary.type = BoundaryType::frame_p;
  EXPECT_THROW(make_material(description), Error);
}

TEST(chain_frame, of_a_layer_is_written_with_its_copies_and_those_it_had) {
  State state(make_material(describe_layer(small_packing(), -1e5)));
  advance(state, {1, 5e-4, 0, 1});
  const Packing written = through_files(as_packing(state.material(), state.committed()));
  State again(make_material(describe_layer(written, -1e5)));
  EXPECT_NEAR(stress_of(again)[3], -1e5, 1);
  // Bottom and top moved on their own.
  EXPECT_THROW(make_material(describe(written, rough_law(), BoundaryType::frame_p)), Error);
}

TEST(chain_frame, escaped_particles_are_counted) {
  State state(make_material(describe(hexagonal(5), paper_law(), BoundaryType::frame_d, 1e-6)));
  EXPECT_EQ(measure(state, GRAINLAW_ESCAPED_PARTICLES), 0);
  Configuration moved = state.committed();
  const auto n = state.material().packing.size();
  moved.coordinates[12] += 10 * radius;
  moved.coordinates[n + 7] -= 10 * radius;
  state.restore(moved);
  EXPECT_EQ(measure(state, GRAINLAW_ESCAPED_PARTICLES), 2);
  State cell(make_material(describe(small_packing(), rough_law())));
  EXPECT_EQ(measure(cell, GRAINLAW_ESCAPED_PARTICLES), 0);
}

}  // namespace
}  // namespace grainlaw::core::test
