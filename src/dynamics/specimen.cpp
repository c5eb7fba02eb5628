#include "dynamics/specimen.hpp"

#include "base/error.hpp"
#include "frame/frame.hpp"
#include "material/material_file.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>

namespace grainlaw::core {
namespace {

// Bits of the sides of a particle in the representative volume.
enum Side : unsigned char { bottom = 1, top = 2, left = 4, right = 8 };

std::vector<unsigned char> sides_of_frame(const Packing& packing) {
  const Frame& frame = *packing.frame;
  const auto corner = corner_indices(frame);
  constexpr std::array<unsigned char, 4> around{bottom, right, top, left};
  std::vector<unsigned char> side(packing.size(), 0);
  const std::size_t count = frame.boundary.size();
  for (std::size_t s = 0; s < 4; ++s) {
    const std::size_t end = s < 3 ? corner[s + 1] : count;
    for (std::size_t k = corner[s]; k <= end; ++k)
      side[static_cast<std::size_t>(frame.boundary[k % count])] |= around[s];
  }
  return side;
}

// Sides of a cell: discs within a radius of the outermost centre; the right end has none.
std::vector<unsigned char> sides_of_cell(const Packing& packing,
                                         const std::vector<double>& position) {
  const std::size_t n = packing.size();
  const auto span = [&](std::size_t component) {
    const auto first = position.begin() + static_cast<std::ptrdiff_t>(component * n);
    const auto [low, high] = std::minmax_element(first, first + static_cast<std::ptrdiff_t>(n));
    return std::array<double, 2>{*low, *high};
  };
  const auto x = span(0), y = span(1);
  std::vector<unsigned char> side(n, 0);
  for (std::size_t p = 0; p < n; ++p) {
    const double r = packing.radius[p];
    if (position[p] < x[0] + r) side[p] |= left;
    if (position[n + p] < y[0] + r) side[p] |= bottom;
    if (position[n + p] > y[1] - r) side[p] |= top;
  }
  return side;
}

// Numbering of the specimen's particles by particle p of tile k.
class Numbering {
 public:
  Numbering(const Packing& packing, const std::vector<unsigned char>& side, std::size_t tiles)
      : n_(packing.size()), tiles_(tiles), left_twin_(n_, none) {
    if (packing.frame) {
      const Frame& frame = *packing.frame;
      std::map<std::tuple<int, int, int>, std::size_t> by_source;
      for (std::size_t p = 0; p < n_; ++p)
        by_source[{frame.source[p], frame.offset[p][0], frame.offset[p][1]}] = p;
      for (std::size_t p = 0; p < n_; ++p)
        if (frame.offset[p][0] == 1)
          left_twin_[p] = by_source.at({frame.source[p], 0, frame.offset[p][1]});
    }
    id_.assign((tiles + 1) * n_, none);
    for (std::size_t k = 0; k <= tiles; ++k)
      for (std::size_t p = 0; p < n_; ++p) {
        const bool own = k < tiles && (left_twin_[p] == none || k + 1 == tiles);
        const bool closing = k == tiles && !packing.frame && (side[p] & left) != 0;
        if (own || closing) id_[k * n_ + p] = size_++;
      }
  }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  // Index of a particle; none: outside the specimen.
  [[nodiscard]] std::size_t at(std::ptrdiff_t tile, std::size_t p) const {
    if (tile < 0 || tile > static_cast<std::ptrdiff_t>(tiles_)) return none;
    const auto k = static_cast<std::size_t>(tile);
    if (left_twin_[p] != none && k + 1 < tiles_) return at(tile + 1, left_twin_[p]);
    return id_[k * n_ + p];
  }
  // Whether the particle is stored with this tile.
  [[nodiscard]] bool owned(std::size_t tile, std::size_t p) const {
    return id_[tile * n_ + p] != none;
  }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  std::size_t n_, tiles_, size_ = 0;
  std::vector<std::size_t> left_twin_, id_;
};

void add_particles(const Material<2>& material, const Numbering& numbering,
                   const std::vector<unsigned char>& side, WaveSpecimen& specimen) {
  const Packing& packing = material.packing;
  const std::vector<double>& position = material.initial.coordinates;
  const std::size_t n = packing.size(), all = numbering.size();
  const bool frame = packing.frame.has_value();
  specimen.position.resize(2 * all);
  specimen.radius.resize(all);
  specimen.mass.resize(all);
  specimen.supported.resize(all);
  specimen.right.resize(all);
  specimen.side.resize(all);
  for (std::size_t k = 0; k <= specimen.tiles; ++k)
    for (std::size_t p = 0; p < n; ++p) {
      if (!numbering.owned(k, p)) continue;
      const std::size_t q = numbering.at(static_cast<std::ptrdiff_t>(k), p);
      specimen.position[q] = position[p] + static_cast<double>(k) * packing.cell[0];
      specimen.position[all + q] = position[n + p];
      const double r = packing.radius[p];
      specimen.radius[q] = r;
      const bool support = (side[p] & (bottom | top)) != 0;
      specimen.mass[q] = packing.density * std::numbers::pi * r * r * packing.thickness *
                         (specimen.shared && support ? 0.5 : 1.0);
      const bool at_left = k == 0 && (side[p] & left) != 0;
      const bool at_right =
          frame ? k + 1 == specimen.tiles && (side[p] & right) != 0 : k == specimen.tiles;
      specimen.right[q] = at_right;
      specimen.side[q] = side[p] & (bottom | top);
      specimen.supported[q] =
          static_cast<unsigned char>(at_left || at_right ? support_x | support_y | support_rotation
                                                         : (support ? support_y : 0));
    }
}

// Copies on the top share the node of their originals on the bottom.
void join_copies(const Packing& packing, const Numbering& numbering, WaveSpecimen& specimen) {
  std::vector<int> original(specimen.size());
  std::iota(original.begin(), original.end(), 0);
  if (specimen.shared) {
    const Frame& frame = *packing.frame;
    std::map<std::array<int, 2>, std::size_t> bottom_of;
    for (std::size_t p = 0; p < packing.size(); ++p)
      if (frame.offset[p][1] == 0) bottom_of[{frame.source[p], frame.offset[p][0]}] = p;
    for (std::size_t k = 0; k < specimen.tiles; ++k)
      for (std::size_t p = 0; p < packing.size(); ++p) {
        if (frame.offset[p][1] != 1) continue;
        const auto tile = static_cast<std::ptrdiff_t>(k);
        const std::size_t twin = bottom_of.at({frame.source[p], frame.offset[p][0]});
        original[numbering.at(tile, p)] = static_cast<int>(numbering.at(tile, twin));
      }
  }
  specimen.node.resize(specimen.size());
  for (std::size_t p = 0; p < specimen.size(); ++p)
    if (original[p] == static_cast<int>(p)) specimen.node[p] = static_cast<int>(specimen.nodes++);
  for (std::size_t p = 0; p < specimen.size(); ++p)
    specimen.node[p] = specimen.node[static_cast<std::size_t>(original[p])];
}

void add_contacts(const Material<2>& material, const Numbering& numbering, WaveSpecimen& specimen) {
  const Configuration<2>& initial = material.initial;
  struct Contact {
    ContactHistory<2> history;
    double moment, gap;
  };
  std::map<std::array<std::int32_t, 2>, Contact> found;
  for (std::size_t k = 0; k <= specimen.tiles; ++k)
    for (std::size_t c = 0; c < initial.contacts.size(); ++c) {
      ContactHistory<2> contact = initial.contacts[c];
      const auto tile = static_cast<std::ptrdiff_t>(k);
      const bool across = !material.packing.frame && contact.shift[1] != 0;
      const std::size_t i = numbering.at(tile, static_cast<std::size_t>(contact.i));
      const std::size_t j = numbering.at(tile + (material.packing.frame ? 0 : contact.shift[0]),
                                         static_cast<std::size_t>(contact.j));
      if (across || i == Numbering::none || j == Numbering::none) continue;
      // Seen from j, the moment is reversed and the tangential component stays.
      double moment = initial.moments.empty() ? 0 : initial.moments[c];
      if (i > j) moment = -moment;
      contact.i = static_cast<std::int32_t>(std::min(i, j));
      contact.j = static_cast<std::int32_t>(std::max(i, j));
      contact.shift = {};
      found.insert({{contact.i, contact.j},
                    {contact, moment, initial.bond_gaps.empty() ? 0 : initial.bond_gaps[c]}});
    }
  for (const auto& [pair, contact] : found) {
    specimen.contacts.push_back(contact.history);
    if (material.law.moments()) specimen.moments.push_back(contact.moment);
    if (!initial.bond_gaps.empty()) specimen.gaps.push_back(contact.gap);
  }
}

}  // namespace

double WaveSpecimen::right_end() const {
  double x = -std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < size(); ++p)
    if (right[p]) x = std::max(x, position[p]);
  return x;
}

double WaveSpecimen::mean_radius() const {
  return std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(size());
}

std::shared_ptr<const Material<2>> material_of_discs(std::string_view text, const std::string& base,
                                                     const std::string& origin) {
  return make_material<2>(parse_material(text, base, origin));
}

WaveSpecimen repeat_along_x(const Material<2>& material, std::size_t tiles) {
  const Packing& packing = material.packing;
  const auto& h = packing.cell;
  const double scale = std::abs(h[0]) + std::abs(h[3]);
  if (std::abs(h[1]) + std::abs(h[2]) > 1e-9 * scale)
    throw Error(GRAINLAW_BAD_PACKING,
                "specimen: the cell of the representative volume is not rectangular");
  WaveSpecimen specimen;
  specimen.tiles = tiles;
  specimen.length = h[0] * static_cast<double>(tiles);
  specimen.height = h[3];
  specimen.thickness = packing.thickness;
  specimen.shared = packing.frame && packing.frame->copies[1] &&
                    material.space.options.weight == ContactWeight::copies;
  const auto side = packing.frame ? sides_of_frame(packing)
                                  : sides_of_cell(packing, material.initial.coordinates);
  const Numbering numbering(packing, side, tiles);
  add_particles(material, numbering, side, specimen);
  join_copies(packing, numbering, specimen);
  add_contacts(material, numbering, specimen);
  return specimen;
}

double mean_density(const Material<2>& material) {
  return material.packing.density * material.space.solid_volume / material.space.reference_volume;
}

}  // namespace grainlaw::core
