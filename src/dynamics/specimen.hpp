// A specimen of particles for waves: representative volumes in a row, with their particles,
// contacts and bonds, supported as in Liu's thesis (2018), figure 4.1.
#pragma once

#include "contact/history.hpp"
#include "contact/law.hpp"
#include "material/material.hpp"

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace grainlaw::core {

// Bits of WaveSpecimen::supported: supported directions of a particle.
enum Support : unsigned char { support_x = 1, support_y = 2, support_rotation = 4 };

// A specimen whose left end is supported and whose right end follows the pulse; bottom and top are
// supported in y. When bottom and top of a frame are copies, the specimen is a slice of an infinite
// layer. Copies then share their motion, and each has half of the mass and of the contacts along
// its side. With contact_weight = "one" bottom and top are free surfaces apart from their supports.
struct WaveSpecimen {
  std::vector<double> position;  // component-major [m]
  std::vector<double> radius;    // [m]
  std::vector<double> mass;      // [kg]
  std::vector<int> node;         // particles of the same node move together
  std::size_t nodes = 0;
  std::vector<unsigned char> supported;  // bits of Support: supported directions
  std::vector<char> right;               // 1: on the right end
  std::vector<unsigned char> side;       // 1: on the bottom, 2: on the top
  // Initial contact histories, ordered by (i, j).
  std::vector<ContactHistory<2>> contacts;
  std::vector<double> moments;  // empty for laws without moments
  std::vector<double> gaps;     // empty unless bonds span gaps
  bool shared = false;          // bottom and top are copies that move together
  double length = 0;            // between the ends [m]
  double height = 0;            // [m]
  double thickness = 0;         // [m]
  std::size_t tiles = 0;

  [[nodiscard]] std::size_t size() const { return radius.size(); }
  [[nodiscard]] double right_end() const;    // x of the right end [m]
  [[nodiscard]] double mean_radius() const;  // [m]
  // Weight of the contact between two particles: 1/2 along a shared side.
  [[nodiscard]] double weight(std::size_t i, std::size_t j) const {
    return shared && (side[i] & side[j]) != 0 ? 0.5 : 1;
  }
};

// Makes a material of discs of the text of its file. Throws Error.
std::shared_ptr<const Material<2>> material_of_discs(std::string_view text, const std::string& base,
                                                     const std::string& origin);

// Repeats the material's representative volume `tiles` times along x, in its equilibrium at F = I.
// Sides of a frame are its own. Sides of a periodic cell are the discs within a radius of the
// outermost centre, and the right end repeats the left one. Throws Error (BAD_PACKING) for a
// cell that is not rectangular.
WaveSpecimen repeat_along_x(const Material<2>& material, std::size_t tiles);

// Mass of the representative volume over its volume [kg/m3], eq. 4.2.
double mean_density(const Material<2>& material);

}  // namespace grainlaw::core
