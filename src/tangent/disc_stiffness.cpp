// Stiffness of contacts of discs, as blocks of the nodes they join.
#include "tangent/stiffness.hpp"

namespace grainlaw::core {

namespace {

using simd::store;
using Lanes = simd::Lanes<4>;
constexpr std::size_t width = 4;
GRAINLAW_INLINE Lanes load(const double* from) { return simd::load<4>(from); }

GRAINLAW_INLINE void add(double* block, const Lanes& value) { store(block, load(block) + value); }

// Adds a contact to the blocks (i, i), (i, j), (j, i) and (j, j), which may coincide.
template <std::size_t b>
GRAINLAW_INLINE void add_contact(const TouchingContact<2>& contact, double* ii, double* ij,
                                 double* ji, double* jj) {
  const double nx = contact.point.normal[0];
  const double ny = contact.point.normal[1];
  const double li = contact.lever_i;
  const double lj = 1 - li;
  const auto& s = contact.stiffness;
  // Force and d ft on j: by motion of the branch along n and t, along x and y, and by weighted
  // rotation.
  const Lanes by_normal{s[0] * nx - s[3] * ny, s[0] * ny + s[3] * nx, s[6], 0};
  const Lanes by_tangential{s[1] * nx - s[4] * ny, s[1] * ny + s[4] * nx, s[7], 0};
  const Lanes by_rotation{s[2] * nx - s[5] * ny, s[2] * ny + s[5] * nx, s[8], 0};
  const Lanes by_x = nx * by_normal - ny * by_tangential;
  const Lanes by_y = ny * by_normal + nx * by_tangential;
  // The force on i is minus the one on j, and both nodes take their share of minus the moment.
  const Lanes row_i{1, 1, b == 3 ? li : 0, 0};
  const Lanes row_j{-1, -1, b == 3 ? lj : 0, 0};
  add(ii, -by_x * row_i);
  add(ii + width, -by_y * row_i);
  add(ij, by_x * row_i);
  add(ij + width, by_y * row_i);
  add(ji, -by_x * row_j);
  add(ji + width, -by_y * row_j);
  add(jj, by_x * row_j);
  add(jj + width, by_y * row_j);
  if constexpr (b == 3) {
    const Lanes at_i = by_rotation * row_i;
    const Lanes at_j = by_rotation * row_j;
    add(ii + 2 * width, li * at_i);
    add(ij + 2 * width, lj * at_i);
    add(ji + 2 * width, li * at_j);
    add(jj + 2 * width, lj * at_j);
  }
}

template <std::size_t b>
GRAINLAW_INLINE void add_all(std::span<const TouchingContact<2>> contacts,
                             const std::int32_t* edge_of_contact, BlockMatrix<4>& matrix) {
  double* const blocks = matrix.blocks.data()->lane;
  const std::size_t edges = matrix.edges.size();
  const auto block = [=](std::size_t index) { return blocks + index * b * width; };
  for (const auto& contact : contacts) {
    const std::size_t i = contact.node_i;
    const std::size_t j = contact.node_j;
    const std::int32_t edge = edge_of_contact[contact.index];
    const auto e = edge < 0 ? i : matrix.nodes + static_cast<std::size_t>(edge);
    const auto upper = e;
    const auto lower = edge < 0 ? i : e + edges;
    add_contact<b>(contact, block(i), block(i < j ? upper : lower), block(i < j ? lower : upper),
                   block(j));
  }
}

GRAINLAW_CLONES void add_contacts_3(std::span<const TouchingContact<2>> contacts,
                                    const std::int32_t* edge_of_contact, BlockMatrix<4>& matrix) {
  add_all<3>(contacts, edge_of_contact, matrix);
}
GRAINLAW_CLONES void add_contacts_2(std::span<const TouchingContact<2>> contacts,
                                    const std::int32_t* edge_of_contact, BlockMatrix<4>& matrix) {
  add_all<2>(contacts, edge_of_contact, matrix);
}

}  // namespace

template <>
void Stiffness<2>::add_contacts() {
  if (matrix_.components == 3) {
    add_contacts_3(touching_, edge_of_contact_.data(), matrix_);
  } else {
    add_contacts_2(touching_, edge_of_contact_.data(), matrix_);
  }
}

// Adds -dr of the moments: m on j and -m on i, changed by normal displacement and by theta_j -
// theta_i.
template <>
void Stiffness<2>::add_moments() {
  const std::size_t edges = matrix_.edges.size();
  for (std::size_t k = 0; k < touching_.size(); ++k) {
    const auto& contact = touching_[k];
    const auto& moment = moments_[k];
    const std::size_t i = contact.node_i;
    const std::size_t j = contact.node_j;
    const std::int32_t edge = edge_of_contact_[contact.index];
    const std::size_t upper = edge < 0 ? i : matrix_.nodes + static_cast<std::size_t>(edge);
    const std::size_t lower = edge < 0 ? i : upper + edges;
    const std::size_t ij = i < j ? upper : lower;
    const std::size_t ji = i < j ? lower : upper;
    const double by[] = {moment.by_normal * contact.point.normal[0],
                         moment.by_normal * contact.point.normal[1], moment.by_spin};
    for (std::size_t l = 0; l < 3; ++l) {
      matrix_.block(i)[l].lane[2] -= by[l];
      matrix_.block(ij)[l].lane[2] += by[l];
      matrix_.block(ji)[l].lane[2] += by[l];
      matrix_.block(j)[l].lane[2] -= by[l];
    }
  }
}

}  // namespace grainlaw::core
