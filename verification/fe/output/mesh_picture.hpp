// Pictures of a deformed mesh coloured by a field.
#pragma once

#include "fe/output/fields.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace verification {

using Polygon = std::vector<Eigen::Vector2d>;  // [m]

// A mesh with one value per patch: the part of an element, or of an outer face of a solid, around an
// integration point. Solids are seen from the front, right and above.
struct MeshPanel {
  std::string title;
  std::vector<Polygon> patches;
  std::vector<double> values;  // of the patches
  std::vector<Polygon> elements;
  std::string axes = {};          // of a solid: what is seen
  std::array<double, 2> range{};  // of the colours; equal ends: the range of the values
};

// Panel of a field with one component at these displacements.
MeshPanel mesh_panel(const Mesh& mesh, const PointField& points,
                     const Eigen::VectorXd& displacement, const Field& field);

// Draws stem.svg and stem.png: panels side by side at one scale, each with its colour scale.
// Returns what run_gnuplot() does.
bool draw_mesh(const std::vector<MeshPanel>& panels, const std::string& title,
               const std::filesystem::path& stem);

}  // namespace verification
