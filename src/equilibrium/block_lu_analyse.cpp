// The symbolic analysis: elimination order, rows of the factor, and where the matrix goes.
#include "equilibrium/block_matrix.hpp"

#include "room.hpp"

#include <amd.h>

#include <algorithm>

namespace grainlaw {

void BlockLU::order(std::size_t nodes, std::span<const Edge> edges) {
  const std::size_t entries = 2 * edges.size();
  const std::size_t slack = entries + entries / 2 + nodes + 1;
  resize_with_room(amd_, 9 * nodes + slack);
  std::fill(amd_.begin(), amd_.end(), 0);
  std::int32_t* begin = amd_.data();
  std::int32_t* length = begin + nodes;
  std::int32_t* size = length + nodes;
  std::int32_t* next = size + nodes;
  std::int32_t* last = next + nodes;
  std::int32_t* head = last + nodes;
  std::int32_t* elements = head + nodes;
  std::int32_t* degree = elements + nodes;
  std::int32_t* flags = degree + nodes;
  std::int32_t* neighbours = flags + nodes;
  for (const auto& [p, q] : edges) {
    ++length[p];
    ++length[q];
  }
  std::int32_t free = 0;
  for (std::size_t q = 0; q < nodes; ++q) {
    begin[q] = free;
    free += length[q];
    length[q] = 0;
  }
  for (const auto& [p, q] : edges) {
    neighbours[begin[p] + length[p]++] = q;
    neighbours[begin[q] + length[q]++] = p;
  }
  double control[AMD_CONTROL];
  double info[AMD_INFO];
  amd_defaults(control);
  amd_2(static_cast<std::int32_t>(nodes), begin, neighbours, length,
        static_cast<std::int32_t>(slack), free, size, next, last, head, elements, degree, flags,
        control, info);
  position_.assign(next, next + nodes);
  resize_with_room(node_, nodes);
  for (std::size_t q = 0; q < nodes; ++q) {
    node_[static_cast<std::size_t>(position_[q])] = static_cast<std::int32_t>(q);
  }
}

// For every row of the factor the columns left of the diagonal that it reaches (Davis 2006, chapter
// 4: paths in the elimination tree), sorted; and how many rows every column has below the diagonal.
void BlockLU::find_reach() {
  resize_with_room(adjacency_begin_, nodes_ + 1);
  std::fill(adjacency_begin_.begin(), adjacency_begin_.end(), 0);
  const auto places = [&](const Edge& edge) {
    return std::minmax(position_[static_cast<std::size_t>(edge.first)],
                       position_[static_cast<std::size_t>(edge.second)]);
  };
  for (const auto& edge : edges_) {
    ++adjacency_begin_[static_cast<std::size_t>(std::get<1>(places(edge))) + 1];
  }
  for (std::size_t j = 0; j < nodes_; ++j) adjacency_begin_[j + 1] += adjacency_begin_[j];
  resize_with_room(adjacency_, edges_.size());
  resize_with_room(below_, nodes_);
  std::copy_n(adjacency_begin_.begin(), nodes_, below_.begin());
  for (const auto& edge : edges_) {
    const auto [low, high] = places(edge);
    adjacency_[below_[static_cast<std::size_t>(high)]++] = low;
  }

  resize_with_room(parent_, nodes_);
  resize_with_room(ancestor_, nodes_);
  resize_with_room(where_, nodes_);
  resize_with_room(reach_begin_, nodes_ + 1);
  std::fill(below_.begin(), below_.end(), 0);
  reach_.clear();
  for (std::size_t j = 0; j < nodes_; ++j) {
    const auto row = static_cast<std::int32_t>(j);
    parent_[j] = ancestor_[j] = -1;
    where_[j] = row;  // visited by this row
    reach_begin_[j] = reach_.size();
    for (std::size_t k = adjacency_begin_[j]; k < adjacency_begin_[j + 1]; ++k) {
      for (std::int32_t r = adjacency_[k]; r != -1 && r < row;) {
        const auto at = static_cast<std::size_t>(r);
        const std::int32_t next = ancestor_[at];
        ancestor_[at] = row;
        if (next == -1) parent_[at] = row;
        r = next;
      }
    }
    for (std::size_t k = adjacency_begin_[j]; k < adjacency_begin_[j + 1]; ++k) {
      for (std::int32_t r = adjacency_[k]; where_[static_cast<std::size_t>(r)] != row;
           r = parent_[static_cast<std::size_t>(r)]) {
        where_[static_cast<std::size_t>(r)] = row;
        ++below_[static_cast<std::size_t>(r)];
        reach_.push_back(r);
      }
    }
    std::sort(reach_.begin() + static_cast<std::ptrdiff_t>(reach_begin_[j]), reach_.end());
  }
  reach_begin_[nodes_] = reach_.size();
  keep_room(reach_);
}

// Column j: its reach above the diagonal, and below it the rows whose reach holds j.
void BlockLU::find_columns() {
  resize_with_room(begin_, nodes_ + 1);
  resize_with_room(diagonal_, nodes_);
  resize_with_room(paired_, nodes_);
  resize_with_room(rows_, nodes_ + 2 * reach_.size());
  std::size_t slot = 0;
  for (std::size_t j = 0; j < nodes_; ++j) {
    paired_[j] = j + 1 < nodes_ && parent_[j] == static_cast<std::int32_t>(j + 1) &&
                 below_[j] == below_[j + 1] + 1;
    begin_[j] = slot;
    for (std::size_t k = reach_begin_[j]; k < reach_begin_[j + 1]; ++k) rows_[slot++] = reach_[k];
    diagonal_[j] = slot;
    rows_[slot++] = static_cast<std::int32_t>(j);
    slot += below_[j];
  }
  begin_[nodes_] = slot;
  for (std::size_t j = 0; j < nodes_; ++j) below_[j] = diagonal_[j] + 1;  // where the next row goes
  for (std::size_t row = 0; row < nodes_; ++row) {
    for (std::size_t k = reach_begin_[row]; k < reach_begin_[row + 1]; ++k) {
      rows_[below_[static_cast<std::size_t>(reach_[k])]++] = static_cast<std::int32_t>(row);
    }
  }
}

// Where the blocks of the matrix go, column by column.
void BlockLU::find_sources() {
  const auto slot_of = [&](std::int32_t row, std::int32_t column) {
    const auto j = static_cast<std::size_t>(column);
    const auto first = rows_.begin() + static_cast<std::ptrdiff_t>(begin_[j]);
    const auto last = rows_.begin() + static_cast<std::ptrdiff_t>(begin_[j + 1]);
    return static_cast<std::int32_t>(std::lower_bound(first, last, row) - rows_.begin());
  };
  const auto places = [&](const Edge& edge) {
    return std::pair{position_[static_cast<std::size_t>(edge.first)],
                     position_[static_cast<std::size_t>(edge.second)]};
  };
  resize_with_room(source_begin_, nodes_ + 1);
  resize_with_room(sources_, 2 * edges_.size());
  std::fill(source_begin_.begin(), source_begin_.end(), 0);
  for (const auto& edge : edges_) {
    const auto [p, q] = places(edge);
    ++source_begin_[static_cast<std::size_t>(p) + 1];
    ++source_begin_[static_cast<std::size_t>(q) + 1];
  }
  for (std::size_t j = 0; j < nodes_; ++j) source_begin_[j + 1] += source_begin_[j];
  std::copy_n(source_begin_.begin(), nodes_, below_.begin());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto [p, q] = places(edges_[e]);
    const auto upper = static_cast<std::int32_t>(nodes_ + e);
    const auto lower = static_cast<std::int32_t>(nodes_ + edges_.size() + e);
    sources_[below_[static_cast<std::size_t>(q)]++] = {slot_of(p, q), upper};
    sources_[below_[static_cast<std::size_t>(p)]++] = {slot_of(q, p), lower};
  }
}

void BlockLU::analyse(const BlockMatrix& matrix, bool keep_order) {
  constexpr double more_fill = 1.1;  // that a kept order may leave
  keep_order = keep_order && nodes_ == matrix.nodes;
  if (nodes_ == matrix.nodes && components_ == matrix.components && edges_ == matrix.edges &&
      (keep_order || ordered_)) {
    return;
  }
  nodes_ = matrix.nodes;
  components_ = matrix.components;
  resize_with_room(edges_, matrix.edges.size());
  std::copy(matrix.edges.begin(), matrix.edges.end(), edges_.begin());
  if (keep_order) find_reach();
  ordered_ = !keep_order || static_cast<double>(reach_.size()) > more_fill * own_fill_;
  if (ordered_) {
    order(nodes_, edges_);
    find_reach();
    own_fill_ = static_cast<double>(reach_.size());
  }
  find_columns();
  find_sources();
}

}  // namespace grainlaw
