#include "fe/mesh/gmsh_file.hpp"

#include "app/library.hpp"
#include "fe/mesh/gmsh_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

namespace verification {
namespace {

// Nodes of a side without their order.
std::vector<int> sorted(Side side) {
  std::sort(side.begin(), side.end());
  return side;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path), content_(read_gmsh(path)) {}

  Mesh mesh() {
    read_elements();
    collect_sides();
    for (const GmshGroup& group : content_.groups)
      if (group.dimension < content_.dimension) read_group(group);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw InputError(fmt::format("{}: found {}, expected {}", path_.string(), found, expected));
  }

  void read_elements() {
    const bool solid = content_.dimension == 3;
    const std::string expected =
        solid ? "one kind of element: hexahedra of 8 or 20 nodes or tetrahedra of 10"
              : "one kind of element: triangles of 3 or 6 nodes or quadrilaterals of 4 or 8 nodes";
    if (content_.elements.empty()) fail("no elements of dimension 2 or 3", expected);
    if (content_.elements.size() > 1)
      fail(fmt::format("elements of Gmsh types {} and {}", content_.elements[0].type,
                       content_.elements[1].type),
           expected);
    const GmshElements& all = content_.elements.front();
    const auto kinds = element_kinds_of(content_.dimension);
    const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](ElementKind candidate) {
      return element_type(candidate).gmsh == all.type;
    });
    if (kind == kinds.end()) fail(fmt::format("elements of Gmsh type {}", all.type), expected);
    mesh_.kind = *kind;
    const std::vector<int>& order = element_type(*kind).gmsh_order;

    number_nodes(std::set<std::size_t>(all.tags.begin(), all.tags.end()));
    for (std::size_t k = 0; k < all.tags.size(); k += all.nodes) {
      std::vector<int> nodes;
      for (std::size_t a = 0; a < all.nodes; ++a) {
        const std::size_t there = order.empty() ? a : static_cast<std::size_t>(order[a]);
        nodes.push_back(number_.at(all.tags[k + there]));
      }
      mesh_.elements.push_back(nodes);
    }
  }

  // Numbers nodes in the order of their tags.
  void number_nodes(const std::set<std::size_t>& used) {
    std::unordered_map<std::size_t, std::size_t> index;
    for (std::size_t k = 0; k < content_.node_tags.size(); ++k) index[content_.node_tags[k]] = k;
    for (const std::size_t tag : used) {
      const auto& [x, y, z] = content_.node_positions[index.at(tag)];
      const bool plane = content_.dimension == 2;
      if (plane && std::abs(z) > 1e-12)
        fail(fmt::format("node {} at z = {}", tag, z), "a mesh in the plane z = 0, or of solids");
      number_[tag] = static_cast<int>(mesh_.nodes.size());
      mesh_.nodes.emplace_back(Eigen::Vector3d(x, y, z).head(content_.dimension));
    }
  }

  void collect_sides() {
    for (const auto& element : mesh_.elements)
      for (const auto& local : element_type(mesh_.kind).sides) {
        Side side;
        for (const int a : local) side.push_back(element[static_cast<std::size_t>(a)]);
        sides_[sorted(side)].push_back(side);
      }
  }

  // The side of an element with these nodes. Inside of the body it has two elements: that on the left
  // of a line of the group counts, and any one of a face.
  [[nodiscard]] const Side* side_with(const Side& nodes) const {
    const auto found = sides_.find(sorted(nodes));
    if (found == sides_.end()) return nullptr;
    for (const Side& side : found->second)
      if (side.front() == nodes.front()) return &side;
    return &found->second.front();
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
        if (group.dimension != content_.dimension - 1) continue;
        const Side* const known = side_with(side);
        if (known == nullptr)
          fail(fmt::format("a {} of group \"{}\" that is no side of an element",
                           group.dimension == 1 ? "line" : "face", group.name),
               "groups of sides");
        mesh_.side_sets[group.name].push_back(*known);
      }
    mesh_.node_sets[group.name].assign(nodes.begin(), nodes.end());
  }

  std::filesystem::path path_;
  GmshContent content_;
  Mesh mesh_;
  std::unordered_map<std::size_t, int> number_;          // number of a node by its tag
  std::map<std::vector<int>, std::vector<Side>> sides_;  // of all elements, by sorted nodes
};

}  // namespace

Mesh read_gmsh_mesh(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw InputError(fmt::format("{}: cannot be read: {}", path.string(),
                                 error ? error.message() : "it is no file"));
  return Reader(path).mesh();
}

}  // namespace verification
