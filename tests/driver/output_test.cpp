// What a run writes: fields at points, ParaView files, pictures of the mesh, tables, cost.
#include "../temporary_directory.hpp"
#include "app/csv.hpp"
#include "app/snapshot.hpp"
#include "fe/output/cost_report.hpp"
#include "fe/output/mesh_picture.hpp"
#include "fe/output/output_options.hpp"
#include "fe/output/vtk_series.hpp"
#include "fe/solver/newton.hpp"
#include "support.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>

namespace verification {
namespace {

using grainlaw::test::TemporaryDirectory;

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A mesh of lattices between smooth platens.
Model compressed_model(ElementKind kind) {
  Model model;
  model.mesh = box_mesh({0.5, 1}, {2, 3}, kind);
  const auto hold = [&](const char* side, int component, double value) {
    model.displacements.push_back(
        {model.mesh.node_sets[side], component, Program::linear(0, value), std::string(side)});
  };
  hold("left", 0, 0);
  hold("bottom", 1, 0);
  hold("top", 1, -1e-4);
  model.loads.pressures.push_back({model.mesh.side_sets["right"], Program::linear(1e5, 1e5), true});
  return model;
}

// The bytes of the array of that name of a VTK file.
template <class T>
std::vector<T> vtk_array(const std::string& text, const std::string& name) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex("Name=\"" + name + "\"[^>]*>\n([^<\n]*)\n")))
    throw std::runtime_error("no array " + name);
  const std::string digits = match[1];
  const std::string order = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned group = 0;
  int bits = 0;
  for (const char digit : digits) {
    if (digit == '=') break;
    group = group << 6 | static_cast<unsigned>(order.find(digit));
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes += static_cast<char>(group >> bits & 255);
    }
  }
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data(), sizeof size);
  EXPECT_EQ(size, bytes.size() - sizeof size);
  std::vector<T> values(size / sizeof(T));
  std::memcpy(values.data(), bytes.data() + sizeof size, size);
  return values;
}

TEST(fields, strains_and_stresses_are_those_of_the_paper) {
  Tensor deformation, stress;
  deformation << 1.03, 0.04, -0.01, 0.99;
  stress << -2e5, 3e4, 1e4, -1e5;
  const grainlaw_report report = grainlaw_report_default();
  const PointView point{nullptr, deformation.data(), stress.data(), report};
  const auto value = [&](const char* name) {
    double result = 0;
    field(name, 2).value(point, &result);
    return result;
  };
  EXPECT_NEAR(value("volumetric_strain"), 1.03 * 0.99 + 0.04 * 0.01 - 1, 1e-15);
  // e = dev(eps): +-0.02 on the diagonal, 0.015 beside it; sqrt(2 e:e).
  EXPECT_NEAR(value("deviatoric_strain"), std::sqrt(2 * (2 * 0.02 * 0.02 + 2 * 0.015 * 0.015)),
              1e-15);
  const Tensor cauchy = cauchy_stress(stress, deformation);
  EXPECT_NEAR(value("mean_stress"), -0.5 * (cauchy(0, 0) + cauchy(1, 1)), 1e-9);
  const double half = 0.5 * (cauchy(0, 0) - cauchy(1, 1));
  EXPECT_NEAR(
      value("deviatoric_stress"),
      std::sqrt(half * half + 0.5 * (cauchy(0, 1) * cauchy(0, 1) + cauchy(1, 0) * cauchy(1, 0))),
      1e-9);
  EXPECT_THROW(field("colour", 2), InputError);
}

class output : public testing::TestWithParam<ElementKind> {
 protected:
  output()
      : model_(compressed_model(GetParam())),
        material_(lattice_material()),
        solver_(make_newton_solver(model_, material_, {}, 1)) {
    solver_->advance(0, 0);
    step_ = solver_->advance(1, 1);
  }

  Model model_;
  Material material_;
  std::unique_ptr<Solver> solver_;
  LoadStep step_;
};

TEST_P(output, patches_of_a_picture_fill_their_elements_and_hold_their_points) {
  const PointField& points = solver_->points();
  const MeshPanel panel =
      mesh_panel(model_.mesh, points, solver_->displacement(), field("deviatoric_strain", 2));
  ASSERT_EQ(panel.patches.size(), points.size());
  ASSERT_EQ(panel.elements.size(), model_.mesh.elements.size());
  const std::size_t per_element = points.size() / panel.elements.size();
  for (std::size_t e = 0; e < panel.elements.size(); ++e) {
    double area = 0;
    for (std::size_t p = e * per_element; p < (e + 1) * per_element; ++p) {
      area += polygon_area(panel.patches[p]);
      const Eigen::Vector2d place =
          current_position(model_.mesh, points, p, solver_->displacement());
      for (std::size_t a = 0; a < panel.patches[p].size(); ++a) {
        const Eigen::Vector2d side =
            panel.patches[p][(a + 1) % panel.patches[p].size()] - panel.patches[p][a];
        const Eigen::Vector2d to = place - panel.patches[p][a];
        EXPECT_GT(side.x() * to.y() - side.y() * to.x(), 0) << "point " << p;
      }
    }
    EXPECT_NEAR(area, polygon_area(panel.elements[e]), 1e-9 * area);
  }
  EXPECT_THROW(mesh_panel(model_.mesh, points, solver_->displacement(), field("stress", 2)),
               InputError);
}

TEST_P(output, files_for_paraview_hold_the_values) {
  const TemporaryDirectory directory;
  VtkSeries series(model_, directory.path() / "s", {1});
  series.add(step_, *solver_);
  const PointField& points = solver_->points();

  const std::string grid = contents(directory.path() / "s_mesh_0001.vtu");
  const auto displacement = vtk_array<double>(grid, "displacement");
  const auto force = vtk_array<double>(grid, "reaction_force");
  ASSERT_EQ(displacement.size(), 3 * model_.mesh.nodes.size());
  for (std::size_t n = 0; n < model_.mesh.nodes.size(); ++n)
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_EQ(displacement[3 * n + k],
                solver_->displacement()(static_cast<Eigen::Index>(2 * n + k)));
  // Support by support the force that holds it; nothing where nothing is held.
  double held = 0;
  for (std::size_t c = 0; c < model_.displacements.size(); ++c) {
    const PrescribedDisplacement& condition = model_.displacements[c];
    double sum = 0;
    for (const int node : condition.nodes)
      sum += force[static_cast<std::size_t>(3 * node + condition.component)];
    EXPECT_NEAR(sum, step_.reactions[c], 1e-9 * std::abs(step_.reactions[c]));
    held += std::abs(sum);
  }
  const auto corner = static_cast<std::size_t>(model_.mesh.node_sets["right"].back());
  EXPECT_LT(std::abs(force[3 * corner]), 1e-6 * held);

  const auto connectivity = vtk_array<std::int64_t>(grid, "connectivity");
  const auto offsets = vtk_array<std::int64_t>(grid, "offsets");
  ASSERT_EQ(offsets.size(), model_.mesh.elements.size());
  EXPECT_EQ(static_cast<std::size_t>(offsets.back()), connectivity.size());
  EXPECT_EQ(vtk_array<std::uint8_t>(grid, "types").size(), offsets.size());

  const std::string at_points = contents(directory.path() / "s_points_0001.vtp");
  const auto place = vtk_array<double>(at_points, "points");
  ASSERT_EQ(place.size(), 3 * points.size());
  for (const Field& field : fields(2)) {
    const auto components = static_cast<std::size_t>(field.components);
    const std::vector<double> expected = values(field, points);
    EXPECT_EQ(vtk_array<double>(at_points, std::string(field.name)), expected) << field.name;
    // The mean over an element lies within its points.
    const auto means = vtk_array<double>(grid, std::string(field.name));
    ASSERT_EQ(means.size(), components * offsets.size());
    const std::size_t per_element = points.size() / offsets.size();
    double low = expected[0], high = expected[0];
    for (std::size_t p = 0; p < per_element; ++p) {
      low = std::min(low, expected[p * components]);
      high = std::max(high, expected[p * components]);
    }
    const double rounding = 1e-12 * std::max(std::abs(low), std::abs(high));
    EXPECT_GE(means[0], low - rounding) << field.name;
    EXPECT_LE(means[0], high + rounding) << field.name;
  }

  EXPECT_TRUE(std::filesystem::exists(directory.path() / "s_packing1_0001.vtp"));
  EXPECT_NE(contents(directory.path() / "s_mesh.pvd")
                .find("timestep=\"1\" part=\"0\" file=\"s_mesh_0001.vtu\""),
            std::string::npos);
}

TEST_P(output, cost_adds_up) {
  const TemporaryDirectory directory;
  CsvWriter table(directory.path() / "cost.csv", cost_columns());
  const std::size_t count = solver_->points().size();
  CsvWriter point_table(directory.path() / "every_cost.csv", point_cost_columns(count));
  CostReport report(*solver_, &point_table);
  report.add(solver_->advance(1.1, 2), table);
  const CsvTable costs = read_csv(directory.path() / "cost.csv");
  double stages = 0;
  for (const char* name : {"points", "assembly", "linear_solve", "output"})
    stages += costs[std::string(name) + "_core_time"][0];
  EXPECT_GT(costs["points_core_time"][0], 0);
  EXPECT_LE(stages, costs["core_time"][0] + 1e-6);
  EXPECT_EQ(costs["failed_points"][0], 0);
  double points = 0, dearest = 0;
  const CsvTable every = read_csv(directory.path() / "every_cost.csv");
  for (std::size_t p = 0; p < count; ++p) {
    const double spent = every["point" + std::to_string(p)][0];
    EXPECT_GT(spent, 0) << p;
    points += spent;
    dearest = std::max(dearest, spent);
  }
  EXPECT_LE(1e-3 * points, costs["points_core_time"][0] + 1e-6);
  EXPECT_EQ(costs["dearest_point"][0], dearest);
  EXPECT_LE(costs["median_point"][0], dearest);
  EXPECT_GT(costs["median_point"][0], 0);
  EXPECT_NE(cost_summary(costs, 7).find("7 points: "), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(elements, output,
                         testing::Values(ElementKind::q4, ElementKind::q4r, ElementKind::q8,
                                         ElementKind::t3, ElementKind::t6));

// The front, the right side and the top of a box are seen.
TEST(solid_picture, shows_the_outer_faces_turned_to_the_eye) {
  for (const auto kind : {ElementKind::hex8, ElementKind::hex20, ElementKind::tet10}) {
    Model model;
    model.mesh = box_mesh({0.5, 0.4, 1}, {1, 1, 2}, kind);
    const Material material = lattice_of(3);
    PointField points(model, material);
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.mesh.dofs());
    points.evaluate(rest, 0, 1);
    const MeshPanel panel = mesh_panel(model.mesh, points, rest, field("mean_stress", 3));
    const std::size_t faces = model.mesh.side_sets["front"].size() +
                              model.mesh.side_sets["right"].size() +
                              model.mesh.side_sets["top"].size();
    EXPECT_EQ(panel.elements.size(), faces);
    EXPECT_EQ(panel.patches.size(), panel.values.size());
    double area = 0, patches = 0;
    for (const Polygon& face : panel.elements) area += polygon_area(face);
    for (const Polygon& patch : panel.patches) patches += polygon_area(patch);
    EXPECT_NEAR(patches, area, 1e-12);
    for (const double value : panel.values) EXPECT_NEAR(value, panel.values[0], 1e-6);
  }
}

TEST(output_options, wrong_ones_are_refused_with_what_was_expected) {
  const Mesh mesh = box_mesh({1, 1}, {1, 2}, ElementKind::q4);  // 8 points
  const auto refusal = [&](const std::string& text) {
    const toml::table content = toml::parse(text).table();
    SceneTable table(content, "scene.toml", "");
    try {
      read_output(table, mesh, 10);
      table.close();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal("points = [7]\nvtk_every = 2\npackings = [0]\nevery_point = ['cost']\n"
                    "[picture]\nfields = [\"void_ratio\"]\nsteps = [10]"),
            "accepted");
  for (const auto& [text, expected] : {std::pair{"points = [8]", "integration points, 0 to 7"},
                                       {"points = [-1]", "integration points, 0 to 7"},
                                       {"points = 1", "integration points, 0 to 7"},
                                       {"points = [1.5]", "integration points, 0 to 7"},
                                       {"packings = [1]", "vtk_every"},
                                       {"vtk_every = -1", "vtk_every"},
                                       {"checkpoint_every = -1", "checkpoint_every"},
                                       {"[picture]\nfields = [\"colour\"]", "void_ratio"},
                                       {"[picture]\nfields = [\"stress\"]", "void_ratio"},
                                       {"[picture]\nfields = [\"cost\"]", "void_ratio"},
                                       {"[picture]\nsteps = [11]", "load steps, 0 to 10"},
                                       {"[picture]\nstep = [1]", "picture.step"}})
    EXPECT_NE(refusal(text).find(expected), std::string::npos) << text << ": " << refusal(text);
}

TEST(snapshot, forces_are_drawn_beside_a_packing_without_any) {
  const TemporaryDirectory directory;
  Snapshot free{{0, 2}, {0, 0}, {1, 1}, {0, 0}, {}, {4, 0, 0, 4}, {}};
  Snapshot bearing = free;
  bearing.contacts = {{0, 1, {2, 0}, 5, false}};
  const auto bars = [&](const char* name, const std::vector<SnapshotPanel>& panels) {
    const auto stem = directory.path() / name;
    EXPECT_TRUE(draw_snapshots(panels, 0, name, stem));
    const std::string picture = contents(stem.string() + ".svg");
    return picture.find("stroke='#0072b2'") != std::string::npos;
  };
  EXPECT_FALSE(bars("free", {{"", free}}));
  EXPECT_TRUE(bars("beside", {{"", free}, {"", bearing}}));
}

TEST(csv, is_continued_after_the_length_that_is_given) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "a.csv";
  std::uintmax_t length = 0;
  {
    CsvWriter table(path, {"a[-]", "b[-]"});
    table.row({1, 2});
    length = table.length();
    table.row({3, 4});
  }
  {
    CsvWriter table(path, {"a[-]", "b[-]"}, length);
    table.row({5, 6});
  }
  EXPECT_EQ(contents(path), "a[-],b[-]\n1,2\n5,6\n");
  EXPECT_THROW(CsvWriter(path, {"a[-]", "c[-]"}, length), InputError);
  EXPECT_THROW(CsvWriter(path, {"a[-]", "b[-]"}, 1000), InputError);
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_THROW(CsvWriter("/dev/full", {"a[-]"}), ComputationError);
  }
}

}  // namespace
}  // namespace verification
