#include "tangent/stiffness.hpp"
#include "tangent/drag_change.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include "base/capacity.hpp"
#include "base/constants.hpp"
#include "increment/contact_state.hpp"

namespace grainlaw::core {

namespace {

SizeOfFour block_size(const Problem<2>& problem) {
  return problem.law->rotating() ? blocks_of_3 : blocks_of_2;
}
SizeOfEight block_size(const Problem<3>& /*problem*/) { return blocks_of_6; }

}  // namespace

template <int D>
void Stiffness<D>::find_touching(const Increment<D>& increment) {
  const auto& list = increment.contacts();
  const auto& node = increment.problem().space->node;
  const auto& law = *increment.problem().law;
  touching_.clear();
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (surely_open(increment, c)) continue;
    const auto point = contact_point(list, c, increment.motion().coordinates(),
                                     increment.problem().particles(), law);
    if (point.status == ContactStatus::open) continue;
    auto& contact = touching_.emplace_back();
    contact.index = c;
    contact.node_i = static_cast<std::size_t>(node[static_cast<std::size_t>(list.i[c])]);
    contact.node_j = static_cast<std::size_t>(node[static_cast<std::size_t>(list.j[c])]);
    contact.lever_i = list.lever_i[c];
    contact.reach = list.reach[c];
    contact.point = point;
    contact.stiffness = contact_stiffness(list, c, point, law);
  }
  keep_capacity(touching_);
  moments_.clear();
  if (!law.moments()) return;
  for (const auto& contact : touching_) {
    moments_.push_back(contact_moment(list, contact.index, contact.point,
                                      increment.motion().coordinates(),
                                      increment.problem().particles(), law));
  }
  keep_capacity(moments_);
}

// True if the graph was made in this increment from these contacts and contains all touching ones.
template <int D>
bool Stiffness<D>::graph_serves(const Increment<D>& increment) const {
  const auto& list = increment.contacts();
  if (factorised_ != increment.epoch() || listed_i_.size() != list.size() ||
      !std::equal(listed_i_.begin(), listed_i_.end(), list.i.begin()) ||
      !std::equal(listed_j_.begin(), listed_j_.end(), list.j.begin())) {
    return false;
  }
  return std::all_of(touching_.begin(), touching_.end(), [this](const TouchingContact<D>& contact) {
    return edge_of_contact_[contact.index] != not_in_graph;
  });
}

template <int D>
void Stiffness<D>::find_graph(const Increment<D>& increment) {
  const auto& list = increment.contacts();
  const auto& node = increment.problem().space->node;
  resize_with_capacity(listed_i_, list.size());
  resize_with_capacity(listed_j_, list.size());
  std::copy_n(list.i.begin(), list.size(), listed_i_.begin());
  std::copy_n(list.j.begin(), list.size(), listed_j_.begin());
  pairs_.clear();
  resize_with_capacity(edge_of_contact_, list.size());
  std::fill(edge_of_contact_.begin(), edge_of_contact_.end(), not_in_graph);
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (overlap_of(increment, c) < -0.5 * tuned::graph_gap * list.reach[c] && !list.bonded(c))
      continue;
    const auto [a, b] = std::minmax(node[static_cast<std::size_t>(list.i[c])],
                                    node[static_cast<std::size_t>(list.j[c])]);
    edge_of_contact_[c] = on_the_diagonal;
    if (a != b) pairs_.push_back({{a, b}, static_cast<std::int32_t>(c)});
  }
  if constexpr (D == 2) {
    if (increment.problem().space->averages()) link_anchors(increment);
  }
  keep_capacity(pairs_);
  if (!std::is_sorted(pairs_.begin(), pairs_.end())) std::sort(pairs_.begin(), pairs_.end());
  graph_.clear();
  for (const auto& [edge, c] : pairs_) {
    if (graph_.empty() || graph_.back() != edge) graph_.push_back(edge);
    const auto index = static_cast<std::int32_t>(graph_.size()) - 1;
    if (c >= 0) {
      edge_of_contact_[static_cast<std::size_t>(c)] = index;
    } else {
      edge_of_link_[static_cast<std::size_t>(-c - 1)] = index;
    }
  }
  keep_capacity(graph_);
}

template <int D>
void Stiffness<D>::assemble(const Increment<D>& increment, double shift) {
  find_touching(increment);
  if (graph_serves(increment)) {
    matrix_.set_zero();
    if (factors_ == Factors::of_matrix) factors_ = Factors::of_earlier_matrix;
  } else {
    find_graph(increment);
    matrix_.reset(increment.problem().nodes(), block_size(increment.problem()), graph_);
    factors_ = Factors::none;
  }
  add_contacts();
  if (!moments_.empty()) add_moments();
  add_masses(increment, shift);
  const bool drag = increment.motion().drag().acts();
  if (drag) add_drag(increment);
  if constexpr (D == 3) {
    if (!increment.problem().law->rotating()) {
      regularise_rotations(increment);
    } else if (!drag) {
      add_chord_springs(increment);
    }
  }
  if (increment.problem().space->identity) return;
  if constexpr (D == 2) {
    if (increment.problem().space->averages()) add_anchors(increment);
  }
  fix_nodes(increment);
}

template <int D>
void Stiffness<D>::fix_nodes(const Increment<D>& increment) {
  const auto& fixed = increment.problem().space->fixed;
  const auto b = static_cast<std::size_t>(matrix_.components);
  const auto clear = [&](std::size_t index, unsigned char bits, bool rows) {
    Column* block = matrix_.block(index);
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

template <int D>
void Stiffness<D>::add_masses(const Increment<D>& increment, double factor) {
  if (factor == 0) return;
  const auto b = static_cast<std::size_t>(matrix_.components);
  for (std::size_t q = 0; q < matrix_.nodes; ++q) {
    Column* block = matrix_.block(q);
    for (std::size_t k = 0; k < b; ++k) {
      block[k].lane[k] += factor * increment.masses().of_unknowns()[k * matrix_.nodes + q];
    }
  }
}

template <int D>
void Stiffness<D>::add_drag(const Increment<D>& increment) {
  const auto b = static_cast<std::size_t>(matrix_.components);
  constexpr std::size_t spins = Dimension<D>::spins;
  for (std::size_t q = 0; q < matrix_.nodes; ++q) {
    Column* block = matrix_.block(q);
    const double* stiffness = &increment.motion().drag().stiffness(q).x;
    for (std::size_t k = 0; k < D; ++k) block[k].lane[k] += stiffness[k];
    const double radius = increment.motion().node_radius()[q];
    const auto by_spin = rotation_by_spin<D>(increment, q);
    for (std::size_t k = 0; k + D < b; ++k) {
      for (std::size_t l = 0; l + D < b; ++l) {
        block[D + l].lane[D + k] += radius * radius * stiffness[D + k] * by_spin[k * spins + l];
      }
    }
  }
}

// Regularises the rotations of particles that do not rotate.
template <int D>
void Stiffness<D>::regularise_rotations(const Increment<D>& increment) {
  for (std::size_t q = 0; q < matrix_.nodes; ++q) regularise_rotation(increment, q);
}

template void Stiffness<2>::assemble(const Increment<2>&, double);
template void Stiffness<3>::assemble(const Increment<3>&, double);

}  // namespace grainlaw::core
