#include "fe/mesh/gmsh_file.hpp"

#include "app/library.hpp"
#include "fe/mesh/gmsh_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>
#include <utility>

namespace verification {
namespace {

// Gmsh's element types.
enum GmshType : int { line2 = 1, triangle3 = 2, quadrangle4 = 3, line3 = 8, quadrangle8 = 16 };

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path), content_(read_gmsh(path)) {}

  Mesh mesh() {
    read_elements();
    collect_sides();
    for (const GmshGroup& group : content_.groups)
      if (group.dimension < 2) read_group(group);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw InputError(fmt::format("{}: found {}, expected {}", path_.string(), found, expected));
  }

  void read_elements() {
    const std::string expected =
        "one kind of element: triangles of 3 nodes or quadrilaterals of 4 or 8 nodes";
    if (content_.surface.empty()) fail("no elements of dimension 2", expected);
    if (content_.surface.size() > 1)
      fail(fmt::format("elements of Gmsh types {} and {}", content_.surface[0].type,
                       content_.surface[1].type),
           expected);
    const GmshElements& all = content_.surface.front();
    if (all.type == triangle3)
      mesh_.kind = ElementKind::t3;
    else if (all.type == quadrangle4)
      mesh_.kind = ElementKind::q4;
    else if (all.type == quadrangle8)
      mesh_.kind = ElementKind::q8;
    else
      fail(fmt::format("elements of Gmsh type {}", all.type), expected);

    number_nodes(std::set<std::size_t>(all.tags.begin(), all.tags.end()));
    for (std::size_t k = 0; k < all.tags.size(); k += all.nodes) {
      std::vector<int> nodes;
      for (std::size_t a = 0; a < all.nodes; ++a) nodes.push_back(number_.at(all.tags[k + a]));
      mesh_.elements.push_back(nodes);
    }
  }

  // Numbers nodes in the order of their tags.
  void number_nodes(const std::set<std::size_t>& used) {
    std::unordered_map<std::size_t, std::size_t> index;
    for (std::size_t k = 0; k < content_.node_tags.size(); ++k) index[content_.node_tags[k]] = k;
    for (const std::size_t tag : used) {
      const auto& [x, y, z] = content_.node_positions[index.at(tag)];
      if (std::abs(z) > 1e-12)
        fail(fmt::format("node {} at z = {}", tag, z), "a mesh in the plane z = 0");
      number_[tag] = static_cast<int>(mesh_.nodes.size());
      mesh_.nodes.emplace_back(x, y);
    }
  }

  void collect_sides() {
    const auto corners = static_cast<std::size_t>(element_type(mesh_.kind).corners);
    for (const auto& nodes : mesh_.elements)
      for (std::size_t a = 0; a < corners; ++a) ways_.emplace(nodes[a], nodes[(a + 1) % corners]);
  }

  void read_group(const GmshGroup& group) {
    std::set<int> nodes;
    for (const GmshElements& part : group.elements)
      for (std::size_t k = 0; k < part.tags.size(); k += part.nodes) {
        Side side;
        for (std::size_t a = 0; a < part.nodes; ++a) {
          const auto number = number_.find(part.tags[k + a]);
          if (number == number_.end())
            fail(fmt::format("node {} of group \"{}\" in no element", part.tags[k + a], group.name),
                 "groups of nodes and sides of elements");
          side.push_back(number->second);
        }
        nodes.insert(side.begin(), side.end());
        if (group.dimension == 0) continue;
        if (!ways_.contains({side[0], side[1]})) std::swap(side[0], side[1]);
        if (!ways_.contains({side[0], side[1]}))
          fail(fmt::format("a line of group \"{}\" that is no side of an element", group.name),
               "groups of sides");
        mesh_.side_sets[group.name].push_back(side);
      }
    mesh_.node_sets[group.name].assign(nodes.begin(), nodes.end());
  }

  std::filesystem::path path_;
  GmshContent content_;
  Mesh mesh_;
  std::unordered_map<std::size_t, int> number_;  // number of a node by its tag
  std::set<std::pair<int, int>> ways_;           // directed sides, elements on the left
};

}  // namespace

Mesh read_gmsh_mesh(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path))
    throw InputError(fmt::format("{}: there is no such file", path.string()));
  return Reader(path).mesh();
}

}  // namespace verification
