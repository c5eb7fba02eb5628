// The symbolic analysis: elimination order, tree, fronts, and where the matrix goes.
#include "equilibrium/block_lu.hpp"

#include "equilibrium/dense_panels.hpp"
#include "room.hpp"

#include <amd.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace grainlaw {

namespace {

std::size_t at(std::int32_t place) { return static_cast<std::size_t>(place); }

}  // namespace

void BlockLU::list_neighbours() {
  resize_with_room(neighbours_begin_, nodes_ + 1);
  std::fill(neighbours_begin_.begin(), neighbours_begin_.end(), 0);
  for (const auto& [p, q] : edges_) {
    ++neighbours_begin_[at(p) + 1];
    ++neighbours_begin_[at(q) + 1];
  }
  std::partial_sum(neighbours_begin_.begin(), neighbours_begin_.end(), neighbours_begin_.begin());
  resize_with_room(neighbours_, 2 * edges_.size());
  resize_with_room(next_, nodes_);
  std::copy_n(neighbours_begin_.begin(), nodes_, next_.begin());
  for (const auto& [p, q] : edges_) {
    neighbours_[next_[at(p)]++] = q;
    neighbours_[next_[at(q)]++] = p;
  }
}

void BlockLU::order() {
  const std::size_t entries = neighbours_.size();
  const std::size_t slack = entries + entries / 2 + nodes_ + 1;
  resize_with_room(amd_, 9 * nodes_ + slack);
  std::fill(amd_.begin(), amd_.end(), 0);
  std::int32_t* begin = amd_.data();
  std::int32_t* length = begin + nodes_;
  std::int32_t* size = length + nodes_;
  std::int32_t* next = size + nodes_;
  std::int32_t* last = next + nodes_;
  std::int32_t* head = last + nodes_;
  std::int32_t* elements = head + nodes_;
  std::int32_t* degree = elements + nodes_;
  std::int32_t* flags = degree + nodes_;
  std::int32_t* neighbours = flags + nodes_;
  for (std::size_t q = 0; q < nodes_; ++q) {
    begin[q] = static_cast<std::int32_t>(neighbours_begin_[q]);
    length[q] = static_cast<std::int32_t>(neighbours_begin_[q + 1] - neighbours_begin_[q]);
  }
  std::copy(neighbours_.begin(), neighbours_.end(), neighbours);
  double control[AMD_CONTROL];
  double info[AMD_INFO];
  amd_defaults(control);
  amd_2(static_cast<std::int32_t>(nodes_), begin, neighbours, length,
        static_cast<std::int32_t>(slack), static_cast<std::int32_t>(entries), size, next, last,
        head, elements, degree, flags, control, info);
  position_.assign(next, next + nodes_);
  resize_with_room(node_, nodes_);
  for (std::size_t q = 0; q < nodes_; ++q) node_[at(position_[q])] = static_cast<std::int32_t>(q);
}

// The elimination tree (Liu 1986): parent_ of every place, -1 at a root.
void BlockLU::find_tree() {
  resize_with_room(parent_, nodes_);
  resize_with_room(ancestor_, nodes_);
  for (std::size_t j = 0; j < nodes_; ++j) {
    const auto place = static_cast<std::int32_t>(j);
    parent_[j] = ancestor_[j] = -1;
    const std::size_t node = at(node_[j]);
    for (std::size_t k = neighbours_begin_[node]; k < neighbours_begin_[node + 1]; ++k) {
      for (std::int32_t r = position_[at(neighbours_[k])]; r != -1 && r < place;) {
        const std::int32_t next = ancestor_[at(r)];
        ancestor_[at(r)] = place;
        if (next == -1) parent_[at(r)] = place;
        r = next;
      }
    }
  }
}

// Children right before their parents, the order of siblings kept: the same elimination otherwise.
void BlockLU::sort_by_tree() {
  resize_with_room(child_, nodes_);
  resize_with_room(sibling_, nodes_);
  resize_with_room(order_, nodes_);
  std::fill(child_.begin(), child_.end(), -1);
  std::int32_t roots = -1;
  for (std::size_t j = nodes_; j-- > 0;) {
    std::int32_t& head = parent_[j] == -1 ? roots : child_[at(parent_[j])];
    sibling_[j] = head;
    head = static_cast<std::int32_t>(j);
  }
  std::int32_t place = 0;
  for (std::int32_t root = roots; root != -1; root = sibling_[at(root)]) {
    for (std::int32_t j = root;;) {
      while (child_[at(j)] != -1) {  // down, forgetting the way
        const std::int32_t child = child_[at(j)];
        child_[at(j)] = -1;
        j = child;
      }
      order_[at(j)] = place++;
      if (j == root) break;
      j = sibling_[at(j)] != -1 ? sibling_[at(j)] : parent_[at(j)];
    }
  }
  for (std::size_t q = 0; q < nodes_; ++q) position_[q] = order_[at(position_[q])];
  for (std::size_t q = 0; q < nodes_; ++q) node_[at(position_[q])] = static_cast<std::int32_t>(q);
  for (std::size_t j = 0; j < nodes_; ++j) {
    const std::int32_t parent = parent_[j];
    ancestor_[at(order_[j])] = parent == -1 ? -1 : order_[at(parent)];
  }
  parent_.swap(ancestor_);
}

// For every place the later ones that its column of the factor reaches, in any order; a column that has those
// of the one before it but for itself shares its list. below_ counts them.
void BlockLU::find_structure() {
  find_tree();
  sort_by_tree();
  resize_with_room(structure_begin_, nodes_);
  resize_with_room(below_, nodes_);
  resize_with_room(mark_, nodes_);
  std::fill(mark_.begin(), mark_.end(), -1);
  std::fill(child_.begin(), child_.end(), -1);
  structure_.clear();
  fill_ = 0;
  for (std::size_t j = 0; j < nodes_; ++j) {
    const auto place = static_cast<std::int32_t>(j);
    const std::size_t begin = structure_.size();
    const auto add = [&](std::int32_t row) {
      if (row <= place || mark_[at(row)] == place) return;
      mark_[at(row)] = place;
      structure_.push_back(row);
    };
    for (std::int32_t child = child_[j]; child != -1; child = sibling_[at(child)]) {
      const std::size_t first = structure_begin_[at(child)];
      for (std::size_t k = 0; k < at(below_[at(child)]); ++k) add(structure_[first + k]);
    }
    const std::size_t node = at(node_[j]);
    for (std::size_t k = neighbours_begin_[node]; k < neighbours_begin_[node + 1]; ++k) {
      add(position_[at(neighbours_[k])]);
    }
    below_[j] = static_cast<std::int32_t>(structure_.size() - begin);
    structure_begin_[j] = begin;
    fill_ += below_[j];
    if (j > 0 && parent_[j - 1] == place && below_[j - 1] == below_[j] + 1) {
      structure_.resize(begin);
      const std::size_t first = structure_begin_[j - 1];
      const auto list = structure_.begin() + static_cast<std::ptrdiff_t>(first);
      std::iter_swap(list, std::find(list, list + below_[j - 1], place));
      structure_begin_[j] = first + 1;
    }
    if (parent_[j] == -1) continue;
    sibling_[j] = child_[at(parent_[j])];
    child_[at(parent_[j])] = place;
  }
  keep_room(structure_);
}

// Columns of one list make a front; so do those of a front and of the one right after it that it is
// left to, where the zeros that this brings cost less than two fronts do.
void BlockLU::find_fronts() {
  const auto goes_on = [&](std::size_t j) {
    return parent_[j - 1] == static_cast<std::int32_t>(j) && below_[j - 1] == below_[j] + 1;
  };
  fronts_.clear();
  // From the last: what comes after a front has been merged as far as it may be.
  for (std::size_t end = nodes_, first = end; end > 0; end = first) {
    --first;
    while (first > 0 && goes_on(first)) --first;
    Front front{};
    front.first = first;
    front.pivots = end - first;
    front.others = at(below_[end - 1]);
    front.rows = structure_begin_[end - 1];
    while (!fronts_.empty()) {
      const Front& next = fronts_.back();
      const std::int32_t parent = parent_[front.first + front.pivots - 1];
      if (parent == -1 || at(parent) >= next.first + next.pivots) break;
      const auto cost = [&](std::size_t pivots, std::size_t others) {
        return dense::Shape(pivots, others, at(components_)).cost();
      };
      if (cost(front.pivots + next.pivots, next.others) >
          cost(front.pivots, front.others) + cost(next.pivots, next.others)) {
        break;
      }
      front.pivots += next.pivots;
      front.others = next.others;
      front.rows = next.rows;
      fronts_.pop_back();
    }
    fronts_.push_back(front);
  }
  keep_room(fronts_);
  std::reverse(fronts_.begin(), fronts_.end());
}

// The others of every front, sorted, and where they are in the front they are left to.
void BlockLU::link_fronts() {
  resize_with_room(front_of_, nodes_);
  rows_.clear();
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    std::fill_n(front_of_.begin() + static_cast<std::ptrdiff_t>(front.first), front.pivots,
                static_cast<std::int32_t>(f));
    const auto begin = structure_.begin() + static_cast<std::ptrdiff_t>(front.rows);
    front.rows = rows_.size();
    rows_.insert(rows_.end(), begin, begin + static_cast<std::ptrdiff_t>(front.others));
    std::sort(rows_.begin() + static_cast<std::ptrdiff_t>(front.rows), rows_.end());
    front.is_leaf = true;
  }
  keep_room(rows_);
  resize_with_room(within_, rows_.size());
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    front.parent = front.others == 0 ? -1 : front_of_[at(rows_[front.rows])];
    if (front.parent == -1) continue;
    Front& parent = fronts_[at(front.parent)];
    front.opens = parent.is_leaf;
    parent.is_leaf = false;
    const std::size_t end = parent.first + parent.pivots;
    std::size_t place = parent.rows;
    for (std::size_t k = front.rows; k < front.rows + front.others; ++k) {
      if (at(rows_[k]) < end) {
        within_[k] = static_cast<std::int32_t>(at(rows_[k]) - parent.first);
        ++front.passed;
        continue;
      }
      while (rows_[place] != rows_[k]) ++place;
      within_[k] = static_cast<std::int32_t>(parent.pivots + place - parent.rows);
    }
  }
}

// In memory. What fronts leave lies on two stacks, by their depth in the tree: while a parent takes
// over what its child leaves, it is on top of the one, the child on top of the other.
void BlockLU::place_fronts() {
  const auto b = static_cast<std::size_t>(components_);
  resize_with_room(mark_, std::max(nodes_, fronts_.size()));
  std::array<std::size_t, 2> top{}, highest{};
  for (std::size_t f = fronts_.size(); f-- > 0;) {
    const std::int32_t parent = fronts_[f].parent;
    mark_[f] = parent == -1 ? 0 : 1 - mark_[at(parent)];
  }
  std::size_t slot = 0;
  std::size_t most = 0;  // others
  const auto open = [&](std::size_t f) {
    Front& front = fronts_[f];
    const dense::Shape shape(front.pivots, front.others, b);
    front.values = slot;
    slot += shape.panel_size();
    most = std::max(most, front.others);
    const std::size_t stack = at(mark_[f]);
    front.left = top[stack];
    top[stack] += shape.left_size();
    highest[stack] = std::max(highest[stack], top[stack]);
  };
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    const Front& front = fronts_[f];
    if (front.is_leaf) open(f);
    if (front.opens) open(at(front.parent));
    top[at(mark_[f])] = front.left;
  }
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    fronts_[f].left += slot + (mark_[f] == 1 ? highest[0] : 0);
  }
  // Registers are filled beyond the last block.
  resize_with_room(runs_, most);
  resize_with_room(values_, slot + highest[0] + highest[1] + dense::group);
}

// Where the blocks of the matrix go, front by front.
void BlockLU::find_sources() {
  const auto b = static_cast<std::size_t>(components_);
  const auto for_each = [&](auto&& visit) {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const std::int32_t p = position_[at(edges_[e].first)];
      const std::int32_t q = position_[at(edges_[e].second)];
      visit(e, std::min(p, q), std::max(p, q), p < q);
    }
  };
  resize_with_room(next_, std::max(nodes_, fronts_.size()));
  std::fill(next_.begin(), next_.end(), 0);
  for_each([&](std::size_t, std::int32_t low, std::int32_t, bool) {
    next_[at(front_of_[at(low)])] += 2;
  });
  std::size_t source = 0;
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    fronts_[f].first_source = source;
    source += next_[f];
    fronts_[f].last_source = source;
    next_[f] = fronts_[f].first_source;
  }
  resize_with_room(sources_, source + ahead);
  for_each([&](std::size_t e, std::int32_t low, std::int32_t high, bool ascending) {
    const std::size_t f = at(front_of_[at(low)]);
    const Front& front = fronts_[f];
    const dense::Shape shape(front.pivots, front.others, b);
    const std::size_t pivot = at(low) - front.first;
    std::size_t other = at(high) - front.first;
    if (other >= front.pivots) {
      const auto begin = rows_.begin() + static_cast<std::ptrdiff_t>(front.rows);
      const auto end = begin + static_cast<std::ptrdiff_t>(front.others);
      other = front.pivots + static_cast<std::size_t>(std::lower_bound(begin, end, high) - begin);
    }
    const std::size_t upper = nodes_ + e;
    const std::size_t lower = upper + edges_.size();
    sources_[next_[f]++] = {front.values + shape.place(pivot, other), shape.pivot_rows,
                            ascending ? upper : lower};
    sources_[next_[f]++] = {front.values + shape.place(other, pivot),
                            other < front.pivots ? shape.pivot_rows : shape.other_rows,
                            ascending ? lower : upper};
  });
}

std::size_t BlockLU::factor_blocks() const { return nodes_ + 2 * static_cast<std::size_t>(fill_); }

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
  list_neighbours();
  if (keep_order) find_structure();
  ordered_ = !keep_order || fill_ > more_fill * own_fill_;
  if (ordered_) {
    order();
    find_structure();
    own_fill_ = fill_;
  }
  find_fronts();
  link_fronts();
  place_fronts();
  find_sources();
}

}  // namespace grainlaw
