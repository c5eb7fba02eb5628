// Meshes from files of Gmsh; where the program was built without it, that such scenes are refused.
#include "fe/mesh/gmsh_file.hpp"
#include "fe/mesh/mesh_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

// Gmsh's library keeps three bytes of a name; asked by sanitizers alone.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libgmsh"; }

namespace verification {
namespace {

// Two unit squares side by side, as quadrilaterals of `order` 1 or 2; the lines of "floor" run to the
// left, the elements on their right. Node 99 belongs to nothing.
std::string text(int order) {
  const std::string nodes1 = "1 0 0 0\n2 1 0 0\n3 2 0 0\n4 2 1 0\n5 1 1 0\n6 0 1 0\n99 5 5 0\n";
  const std::string nodes2 =
      "11 0.5 0 0\n12 1.5 0 0\n13 2 0.5 0\n14 1.5 1 0\n15 0.5 1 0\n16 0 0.5 0\n17 1 0.5 0\n";
  const std::string elements1 =
      "1 15 2 3 1 1\n2 1 2 1 1 2 1\n3 1 2 1 1 3 2\n"
      "4 3 2 2 1 1 2 5 6\n5 3 2 2 1 2 3 4 5\n";
  const std::string elements2 =
      "1 15 2 3 1 1\n2 8 2 1 1 2 1 11\n3 8 2 1 1 3 2 12\n"
      "4 16 2 2 1 1 2 5 6 11 17 15 16\n5 16 2 2 1 2 3 4 5 12 13 14 17\n";
  return std::string("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n") +
         "$PhysicalNames\n3\n0 3 \"corner\"\n1 1 \"floor\"\n2 2 \"sand\"\n$EndPhysicalNames\n" +
         "$Nodes\n" + (order == 1 ? "7\n" : "14\n") + nodes1 + (order == 1 ? "" : nodes2) +
         "$EndNodes\n$Elements\n5\n" + (order == 1 ? elements1 : elements2) + "$EndElements\n";
}

class gmsh : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(path()) << text(1);
    try {
      read_gmsh_mesh(path());
    } catch (const InputError& error) {
      const std::string message = error.what();
      if (message.find("built without Gmsh") != std::string::npos) GTEST_SKIP() << message;
    }
  }
  void TearDown() override { std::filesystem::remove(path()); }
  static std::filesystem::path path() {
    return std::filesystem::temp_directory_path() /
           ("grainlaw_gmsh_" + std::to_string(getpid()) + ".msh");
  }
  static Mesh read(const std::string& content) {
    std::ofstream(path()) << content;
    return read_gmsh_mesh(path());
  }
};

TEST_F(gmsh, quadrilaterals_with_their_named_sets_are_read) {
  for (const int order : {1, 2}) {
    const Mesh mesh = read(text(order));
    EXPECT_EQ(mesh.kind, order == 1 ? ElementKind::q4fbar : ElementKind::q8);
    EXPECT_EQ(mesh.nodes.size(), order == 1 ? 6U : 13U);
    ASSERT_EQ(mesh.elements.size(), 2U);
    double area = 0;
    for (const auto& element : mesh.elements)
      for (const QuadPoint& point : quad_points(mesh.kind, mesh.positions(element)))
        area += point.weight;
    EXPECT_NEAR(area, 2, 1e-14);
    EXPECT_EQ(mesh.node_sets.at("corner"), std::vector<int>{0});
    EXPECT_EQ(mesh.node_sets.at("floor").size(), order == 1 ? 3U : 5U);
    for (const Side& side : mesh.side_sets.at("floor")) {
      const auto place = [&](int node) { return mesh.nodes[static_cast<std::size_t>(node)]; };
      EXPECT_NEAR((place(side[1]) - place(side[0])).x(), 1, 1e-14);  // the element on the left
      if (order == 2) {
        EXPECT_LT((2 * place(side[2]) - place(side[0]) - place(side[1])).norm(), 1e-14);
      }
    }
  }
}

// A box of two elements as Gmsh writes it, with the named surface "floor".
std::string solid_text(ElementKind kind) {
  const Mesh mesh = box_mesh({2, 1, 1}, {2, 1, 1}, kind);
  const ElementType& type = element_type(kind);
  const bool quadratic = type.nodes > type.corners;
  std::string nodes, elements;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    nodes += fmt::format("{} {}\n", n + 1, fmt::join(mesh.nodes[n], " "));
  std::size_t count = 0;
  const auto add = [&](int gmsh, int group, const std::vector<int>& of,
                       const std::vector<int>& order) {
    elements += fmt::format("{} {} 2 {} 1", ++count, gmsh, group);
    for (std::size_t a = 0; a < of.size(); ++a)
      elements +=
          fmt::format(" {}", 1 + of[order.empty() ? a : static_cast<std::size_t>(order[a])]);
    elements += "\n";
  };
  const int face = type.simplex() ? 9 : quadratic ? 16 : 3;
  for (const Side& side : mesh.side_sets.at("bottom")) {
    Side turned = side;  // seen from inside, where Gmsh may stand
    const auto corners = static_cast<std::ptrdiff_t>(type.simplex() ? 3 : 4);
    std::reverse(turned.begin() + 1, turned.begin() + corners);
    std::reverse(turned.begin() + corners, turned.end());
    add(face, 1, turned, {});
  }
  // Place of the nodes of an element in the order of Gmsh.
  std::vector<int> order(type.gmsh_order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    order[static_cast<std::size_t>(type.gmsh_order[k])] = static_cast<int>(k);
  for (const auto& element : mesh.elements) add(type.gmsh, 2, element, order);
  return fmt::format(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"floor\"\n3 2 \"sand\"\n"
      "$EndPhysicalNames\n$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n",
      mesh.nodes.size(), nodes, count, elements);
}

TEST_F(gmsh, solids_are_read_with_faces_seen_from_outside) {
  for (const ElementKind kind : {ElementKind::hex8fbar, ElementKind::hex20, ElementKind::tet10}) {
    const Mesh mesh = read(solid_text(kind)), box = box_mesh({2, 1, 1}, {2, 1, 1}, kind);
    EXPECT_EQ(mesh.kind, kind);
    EXPECT_EQ(mesh.elements, box.elements);
    EXPECT_EQ(mesh.node_sets.at("floor"), box.node_sets.at("bottom"));
    EXPECT_EQ(mesh.side_sets.at("floor"), box.side_sets.at("bottom"));
  }
}

TEST_F(gmsh, what_cannot_be_used_is_refused) {
  std::string lifted = text(1);
  lifted.replace(lifted.find("4 2 1 0"), 7, "4 2 1 3");
  EXPECT_THROW(read(lifted), InputError);
  std::string mixed = text(1);
  mixed.replace(mixed.find("5 3 2 2 1 2 3 4 5"), 17, "5 2 2 2 1 2 3 4");
  EXPECT_THROW(read(mixed), InputError);
  std::string loose = text(1);  // from corner to corner
  loose.replace(loose.find("2 1 2 1 1 2 1"), 13, "2 1 2 1 1 1 4");
  EXPECT_THROW(read(loose), InputError);
  EXPECT_THROW(read("no mesh\n"), InputError);
  EXPECT_THROW(read_gmsh_mesh("nowhere.msh"), InputError);
}

TEST_F(gmsh, a_scene_names_the_file_and_an_inverted_element_is_told) {
  std::string inverted = text(1);
  inverted.replace(inverted.find("5 3 2 2 1 2 3 4 5"), 17, "5 3 2 2 1 5 4 3 2");
  std::ofstream(path()) << inverted;
  const toml::table content = toml::parse("mesh = { file = '" + path().string() + "' }").table();
  SceneTable scene(content, "scene.toml", "");
  SceneTable table = scene.table("mesh");
  try {
    read_mesh(table);
    FAIL() << "nothing was refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("element 2 (q4"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace verification
