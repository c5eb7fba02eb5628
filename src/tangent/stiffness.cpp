#include "tangent/stiffness.hpp"

#include "base/room.hpp"
#include "linear/quad.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw {

using namespace quad;

namespace {

// Contacts with a smaller gap than this, in radii, are kept in the graph although they carry
// nothing, so that it lasts while they open and close.
constexpr double graph_gap = 1e-3;
constexpr std::int32_t not_in_graph = -2;
constexpr std::int32_t on_the_diagonal = -1;

GRAINLAW_INLINE void add(double* block, const Lanes& value) { store(block, load(block) + value); }

// The blocks of (i, i), (i, j), (j, i), (j, j), which may be one.
template <std::size_t b>
GRAINLAW_INLINE void add_contact(const TouchingContact& contact, double* ii, double* ij, double* ji,
                                 double* jj) {
  const double nx = contact.point.normal_x;
  const double ny = contact.point.normal_y;
  const double li = contact.lever_i;
  const double lj = 1 - li;
  const auto& s = contact.stiffness;
  // Force and d ft on j by the motion of the branch along n and t, by that along x and y, and by
  // the weighted rotation.
  const Lanes by_normal{s[0] * nx - s[3] * ny, s[0] * ny + s[3] * nx, s[6], 0};
  const Lanes by_tangential{s[1] * nx - s[4] * ny, s[1] * ny + s[4] * nx, s[7], 0};
  const Lanes by_rotation{s[2] * nx - s[5] * ny, s[2] * ny + s[5] * nx, s[8], 0};
  const Lanes by_x = nx * by_normal - ny * by_tangential;
  const Lanes by_y = ny * by_normal + nx * by_tangential;
  // -dr: minus the force on i is the one on j; both take their share of minus the moment.
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
GRAINLAW_INLINE void add_all(std::span<const TouchingContact> contacts,
                             const std::int32_t* edge_of_contact, BlockMatrix& matrix) {
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

GRAINLAW_CLONES void add_contacts_3(std::span<const TouchingContact> contacts,
                                    const std::int32_t* edge_of_contact, BlockMatrix& matrix) {
  add_all<3>(contacts, edge_of_contact, matrix);
}
GRAINLAW_CLONES void add_contacts_2(std::span<const TouchingContact> contacts,
                                    const std::int32_t* edge_of_contact, BlockMatrix& matrix) {
  add_all<2>(contacts, edge_of_contact, matrix);
}

}  // namespace

void Stiffness::find_touching(const Increment& increment) {
  const auto& list = increment.contacts;
  const auto& node = increment.problem->space->node;
  const auto& law = *increment.problem->law;
  touching_.clear();
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (increment.surely_open(c)) continue;
    const auto point = contact_point(list, c, increment.coordinates, increment.particles(), law);
    if (point.status == ContactStatus::open) continue;
    auto& contact = touching_.emplace_back();
    contact.index = c;
    contact.node_i = static_cast<std::size_t>(node[static_cast<std::size_t>(list.i[c])]);
    contact.node_j = static_cast<std::size_t>(node[static_cast<std::size_t>(list.j[c])]);
    contact.lever_i = list.lever_i[c];
    contact.point = point;
    contact.stiffness = contact_stiffness(list, c, point, law);
  }
  keep_room(touching_);
  moments_.clear();
  if (!law.moments()) return;
  for (const auto& contact : touching_) {
    moments_.push_back(contact_moment(list, contact.index, contact.point, increment.coordinates,
                                      increment.particles(), law));
  }
  keep_room(moments_);
}

// Whether the graph was made in this increment, from these contacts, and holds all that touch.
bool Stiffness::graph_serves(const Increment& increment) const {
  const auto& list = increment.contacts;
  if (increment.factorisations == 0 || listed_i_.size() != list.size() ||
      !std::equal(listed_i_.begin(), listed_i_.end(), list.i.begin()) ||
      !std::equal(listed_j_.begin(), listed_j_.end(), list.j.begin())) {
    return false;
  }
  return std::all_of(touching_.begin(), touching_.end(), [this](const TouchingContact& contact) {
    return edge_of_contact_[contact.index] != not_in_graph;
  });
}

void Stiffness::find_graph(const Increment& increment) {
  const auto& list = increment.contacts;
  const auto& node = increment.problem->space->node;
  resize_with_room(listed_i_, list.size());
  resize_with_room(listed_j_, list.size());
  std::copy_n(list.i.begin(), list.size(), listed_i_.begin());
  std::copy_n(list.j.begin(), list.size(), listed_j_.begin());
  pairs_.clear();
  resize_with_room(edge_of_contact_, list.size());
  std::fill(edge_of_contact_.begin(), edge_of_contact_.end(), not_in_graph);
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (increment.overlap(c) < -0.5 * graph_gap * list.reach[c] && !list.bonded(c)) continue;
    const auto [a, b] = std::minmax(node[static_cast<std::size_t>(list.i[c])],
                                    node[static_cast<std::size_t>(list.j[c])]);
    edge_of_contact_[c] = on_the_diagonal;
    if (a != b) pairs_.push_back({{a, b}, static_cast<std::int32_t>(c)});
  }
  if (increment.problem->space->averages()) link_anchors(increment);
  keep_room(pairs_);
  if (!std::is_sorted(pairs_.begin(), pairs_.end())) std::sort(pairs_.begin(), pairs_.end());
  graph_.clear();
  for (const auto& [edge, c] : pairs_) {
    if (graph_.empty() || graph_.back() != edge) graph_.push_back(edge);
    const auto place = static_cast<std::int32_t>(graph_.size()) - 1;
    if (c >= 0) {
      edge_of_contact_[static_cast<std::size_t>(c)] = place;
    } else {
      edge_of_link_[static_cast<std::size_t>(-c - 1)] = place;
    }
  }
  keep_room(graph_);
}

void Stiffness::assemble(const Increment& increment, double shift) {
  find_touching(increment);
  if (graph_serves(increment)) {
    matrix_.set_zero();
    if (factors_ == Factors::of_matrix) factors_ = Factors::of_earlier_matrix;
  } else {
    find_graph(increment);
    matrix_.reset(increment.nodes(), increment.problem->components(), graph_);
    factors_ = Factors::none;
  }
  if (matrix_.components == 3) {
    add_contacts_3(touching_, edge_of_contact_.data(), matrix_);
  } else {
    add_contacts_2(touching_, edge_of_contact_.data(), matrix_);
  }
  if (!moments_.empty()) add_moments();
  add_masses(increment, shift);
  if (increment.problem->space->identity) return;
  if (increment.problem->space->averages()) add_anchors(increment);
  hold_fixed_nodes(increment);
}

// Calls visit(number of the link, direction, place of the one node, of the other) for all pairs of
// anchors.
template <class Visit>
void for_each_link(const BoundarySpace& space, Visit&& visit) {
  std::size_t link = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& node = space.average[i].node;
    const std::size_t stride = anchor_stride(space.average[i]);
    for (std::size_t a = 0; a < node.size(); a += stride) {
      for (std::size_t b = a + stride; b < node.size(); b += stride) visit(link++, i, a, b);
    }
  }
}

// A negative number stands for a link where others have that of a contact.
void Stiffness::link_anchors(const Increment& increment) {
  const auto& space = *increment.problem->space;
  std::size_t links = 0;
  for_each_link(space, [&](std::size_t link, std::size_t i, std::size_t a, std::size_t b) {
    const auto& node = space.average[i].node;
    pairs_.push_back({std::minmax(node[a], node[b]), -static_cast<std::int32_t>(link) - 1});
    ++links;
  });
  resize_with_room(edge_of_link_, links);
}

void Stiffness::add_anchors(const Increment& increment) {
  const auto& space = *increment.problem->space;
  const double kn = increment.mean_stiffness();
  std::array<double, 2> mean{};
  const auto product = [&](const auto& r, const auto& s) {
    return kn * ((r[0] - mean[0]) * (s[0] - mean[0]) + (r[1] - mean[1]) * (s[1] - mean[1]));
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [node, row, rows] = space.average[i];
    if (rows == 0) continue;
    mean = anchor_mean(space.average[i]);
    for (std::size_t a = 0; a < node.size(); a += anchor_stride(space.average[i])) {
      matrix_.block(static_cast<std::size_t>(node[a]))[i].lane[i] += product(row[a], row[a]);
    }
  }
  for_each_link(space, [&](std::size_t link, std::size_t i, std::size_t a, std::size_t b) {
    const auto& row = space.average[i].row;
    if (a == 0) mean = anchor_mean(space.average[i]);
    const auto edge = static_cast<std::size_t>(edge_of_link_[link]);
    const double value = product(row[a], row[b]);
    matrix_.block(matrix_.upper(edge))[i].lane[i] += value;
    matrix_.block(matrix_.lower(edge))[i].lane[i] += value;
  });
}

// -dr by the moments: m on j and -m on i, changed by the normal displacement and by theta_j - theta_i.
void Stiffness::add_moments() {
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
    const double by[] = {moment.by_normal * contact.point.normal_x,
                         moment.by_normal * contact.point.normal_y, moment.by_spin};
    for (std::size_t l = 0; l < 3; ++l) {
      matrix_.block(i)[l].lane[2] -= by[l];
      matrix_.block(ij)[l].lane[2] += by[l];
      matrix_.block(ji)[l].lane[2] += by[l];
      matrix_.block(j)[l].lane[2] -= by[l];
    }
  }
}

void Stiffness::hold_fixed_nodes(const Increment& increment) {
  const auto& fixed = increment.problem->space->fixed;
  const auto b = static_cast<std::size_t>(matrix_.components);
  const auto clear = [&](std::size_t index, unsigned char bits, bool rows) {
    Quad* block = matrix_.block(index);
    for (std::size_t k = 0; k < b; ++k) {
      if ((bits >> k & 1U) == 0) continue;
      for (std::size_t l = 0; l < b; ++l) (rows ? block[l].lane[k] : block[k].lane[l]) = 0;
    }
  };
  for (std::size_t q = 0; q < matrix_.nodes; ++q) {
    if (fixed[q] == 0) continue;
    clear(q, fixed[q], true);
    clear(q, fixed[q], false);
    for (std::size_t k = 0; k < b; ++k) {
      if ((fixed[q] >> k & 1U) != 0) matrix_.block(q)[k].lane[k] = 1;
    }
  }
  for (std::size_t e = 0; e < graph_.size(); ++e) {
    const unsigned char first = fixed[static_cast<std::size_t>(graph_[e].first)];
    const unsigned char second = fixed[static_cast<std::size_t>(graph_[e].second)];
    if (first != 0) clear(matrix_.upper(e), first, true);
    if (first != 0) clear(matrix_.lower(e), first, false);
    if (second != 0) clear(matrix_.upper(e), second, false);
    if (second != 0) clear(matrix_.lower(e), second, true);
  }
}

void Stiffness::add_masses(const Increment& increment, double factor) {
  if (factor == 0) return;
  const auto b = static_cast<std::size_t>(matrix_.components);
  for (std::size_t q = 0; q < matrix_.nodes; ++q) {
    Quad* block = matrix_.block(q);
    for (std::size_t k = 0; k < b; ++k) {
      block[k].lane[k] += factor * increment.mass[k * matrix_.nodes + q];
    }
  }
}

}  // namespace grainlaw
