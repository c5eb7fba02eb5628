// A material that is cheap to evaluate, and what several tests of the driver need.
#pragma once

#include "../data.hpp"
#include "app/material.hpp"
#include "fe/mesh/mesh.hpp"
#include "sphere_lattice.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace verification {

// Four discs in a hexagonal lattice at 100 kPa; discs that touch keep touching and sticking in small
// deformations.
inline Material lattice_material() {
  MaterialSource source;
  source.base = ".";
  source.changes = toml::parse(R"(
    dimension = 2
    thickness = 0.1
    packing = { generator = "hexagonal", columns = 2, rows = 2, radius = 5e-3, pressure = 1e5 }
    contact = { law = "frictional", young = 6e8, ratio = 0.8, friction = 0.5463 }
    boundary = { type = "periodic-cell" }
    solver = { tolerance = 1e-12 }
  )")
                       .table();
  return make_material(source);
}

// Thirty-two spheres at about 700 kPa, near a lattice; those that touch keep touching and sticking in
// small deformations.
inline Material sphere_lattice_material() {
  const grainlaw::test::TemporaryDirectory directory;
  write_sphere_lattice(directory);
  MaterialSource source;
  source.base = directory.path();
  source.changes =
      *toml::parse(sphere_lattice + "solver = { tolerance = 1e-12 }")["material"].as_table();
  return make_material(source, 3);
}

inline Material lattice_of(int dimension) {
  return dimension == 2 ? lattice_material() : sphere_lattice_material();
}

// Discs at 100 kPa, a millisecond an evaluation; viscous_number 0: without drag.
inline Material thirty_discs(int seed, double viscous_number) {
  MaterialSource source;
  source.base = ".";
  source.changes = toml::parse(R"(
    dimension = 2
    thickness = 0.1
    packing = { generator = "compaction", count = 30, radii = [2e-3, 4e-3], pressure = 1e5 }
    contact = { law = "frictional", young = 6e8, ratio = 0.8, friction = 0.5463 }
    solver = {}
  )")
                       .table();
  source.changes["packing"].as_table()->insert("seed", seed);
  source.changes["solver"].as_table()->insert("viscous_number", viscous_number);
  return make_material(source);
}

// The 400 discs of tests/data.
inline Material packing_material() {
  MaterialSource source;
  source.file = grainlaw::test::data_file("rve400.toml");
  source.base = grainlaw::test::data_folder();
  return make_material(source);
}

// Kinds of elements that a test is made for, one after the other, and its names.
inline const auto element_kinds =
    testing::Values(ElementKind::q4, ElementKind::q4fbar, ElementKind::q4r, ElementKind::q8,
                    ElementKind::t3, ElementKind::t6);
inline const auto all_element_kinds =
    testing::Values(ElementKind::q4, ElementKind::q4fbar, ElementKind::q4r, ElementKind::q8,
                    ElementKind::t3, ElementKind::t6, ElementKind::hex8, ElementKind::hex8fbar,
                    ElementKind::hex20, ElementKind::tet10);
inline std::string kind_name(const testing::TestParamInfo<ElementKind>& kind) {
  return std::string(element_type(kind.param).name);
}

// Puts nodes amid edges in the middle of their corners.
inline void straighten(Mesh& mesh) {
  const ElementType& type = element_type(mesh.kind);
  const auto corners = static_cast<std::size_t>(type.corners);
  for (const auto& nodes : mesh.elements)
    for (std::size_t m = corners; m < nodes.size(); ++m)
      for (std::size_t a = 0; a < corners; ++a)
        for (std::size_t b = 0; b < a; ++b)
          if (type.local_nodes[m] == 0.5 * (type.local_nodes[a] + type.local_nodes[b]))
            mesh.nodes[static_cast<std::size_t>(nodes[m])] =
                0.5 * (mesh.position(nodes[a]) + mesh.position(nodes[b]));
}

inline double polygon_area(const std::vector<Eigen::Vector2d>& corners) {
  double twice = 0;
  for (std::size_t a = 0; a < corners.size(); ++a) {
    const Eigen::Vector2d& next = corners[(a + 1) % corners.size()];
    twice += corners[a].x() * next.y() - corners[a].y() * next.x();
  }
  return 0.5 * twice;
}

}  // namespace verification
