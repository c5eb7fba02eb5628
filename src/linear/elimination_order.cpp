// Symbolic analysis: elimination order, tree, and the rows that every column of the factor reaches.
#include "linear/elimination.hpp"

#include "base/capacity.hpp"

#include <amd.h>

#include <algorithm>
#include <numeric>

namespace grainlaw::core {

namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

}  // namespace

void Elimination::list_neighbours() {
  resize_with_capacity(neighbours_begin_, nodes_ + 1);
  std::fill(neighbours_begin_.begin(), neighbours_begin_.end(), 0);
  for (const auto& [p, q] : edges_) {
    ++neighbours_begin_[at(p) + 1];
    ++neighbours_begin_[at(q) + 1];
  }
  std::partial_sum(neighbours_begin_.begin(), neighbours_begin_.end(), neighbours_begin_.begin());
  resize_with_capacity(neighbours_, 2 * edges_.size());
  resize_with_capacity(next_, nodes_);
  std::copy_n(neighbours_begin_.begin(), nodes_, next_.begin());
  for (const auto& [p, q] : edges_) {
    neighbours_[next_[at(p)]++] = q;
    neighbours_[next_[at(q)]++] = p;
  }
}

void Elimination::order() {
  const std::size_t entries = neighbours_.size();
  const std::size_t slack = entries + entries / 2 + nodes_ + 1;
  resize_with_capacity(amd_, 9 * nodes_ + slack);
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
  resize_with_capacity(node_, nodes_);
  for (std::size_t q = 0; q < nodes_; ++q) node_[at(position_[q])] = static_cast<std::int32_t>(q);
}

// Finds the elimination tree [liu1986]: the parent of every index, -1 at a root.
void Elimination::find_tree() {
  resize_with_capacity(parent_, nodes_);
  resize_with_capacity(ancestor_, nodes_);
  for (std::size_t j = 0; j < nodes_; ++j) {
    const auto index = static_cast<std::int32_t>(j);
    parent_[j] = ancestor_[j] = -1;
    const std::size_t node = at(node_[j]);
    for (std::size_t k = neighbours_begin_[node]; k < neighbours_begin_[node + 1]; ++k) {
      for (std::int32_t r = position_[at(neighbours_[k])]; r != -1 && r < index;) {
        const std::int32_t next = ancestor_[at(r)];
        ancestor_[at(r)] = index;
        if (next == -1) parent_[at(r)] = index;
        r = next;
      }
    }
  }
}

// Sorts children right before their parents and keeps the order of siblings, which leaves the
// elimination equivalent.
void Elimination::sort_by_tree() {
  resize_with_capacity(child_, nodes_);
  resize_with_capacity(sibling_, nodes_);
  resize_with_capacity(order_, nodes_);
  std::fill(child_.begin(), child_.end(), -1);
  std::int32_t roots = -1;
  for (std::size_t j = nodes_; j-- > 0;) {
    std::int32_t& head = parent_[j] == -1 ? roots : child_[at(parent_[j])];
    sibling_[j] = head;
    head = static_cast<std::int32_t>(j);
  }
  std::int32_t index = 0;
  for (std::int32_t root = roots; root != -1; root = sibling_[at(root)]) {
    for (std::int32_t j = root;;) {
      while (child_[at(j)] != -1) {  // down, and clear the links
        const std::int32_t child = child_[at(j)];
        child_[at(j)] = -1;
        j = child;
      }
      order_[at(j)] = index++;
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

// Finds the later rows that each column of the factor reaches, in any order; below_ counts them. A
// column shares the list of the one before it if the two differ by the column itself alone.
void Elimination::find_structure() {
  find_tree();
  sort_by_tree();
  resize_with_capacity(structure_begin_, nodes_);
  resize_with_capacity(below_, nodes_);
  resize_with_capacity(mark_, nodes_);
  std::fill(mark_.begin(), mark_.end(), -1);
  std::fill(child_.begin(), child_.end(), -1);
  structure_.clear();
  fill_ = 0;
  for (std::size_t j = 0; j < nodes_; ++j) {
    const auto index = static_cast<std::int32_t>(j);
    const std::size_t begin = structure_.size();
    const auto add = [&](std::int32_t row) {
      if (row <= index || mark_[at(row)] == index) return;
      mark_[at(row)] = index;
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
    if (j > 0 && parent_[j - 1] == index && below_[j - 1] == below_[j] + 1) {
      structure_.resize(begin);
      const std::size_t first = structure_begin_[j - 1];
      const auto list = structure_.begin() + static_cast<std::ptrdiff_t>(first);
      std::iter_swap(list, std::find(list, list + below_[j - 1], index));
      structure_begin_[j] = first + 1;
    }
    if (parent_[j] == -1) continue;
    sibling_[j] = child_[at(parent_[j])];
    child_[at(parent_[j])] = index;
  }
  keep_capacity(structure_);
}

std::size_t Elimination::factor_blocks() const {
  return nodes_ + 2 * static_cast<std::size_t>(fill_);
}

void Elimination::analyse(std::size_t nodes, int components, std::span<const Edge> edges,
                          bool keep_order) {
  constexpr double more_fill = 1.1;  // that a kept order may cause
  keep_order = keep_order && analysed_ && nodes_ == nodes;
  if (analysed_ && nodes_ == nodes && components_ == components &&
      std::equal(edges.begin(), edges.end(), edges_.begin(), edges_.end()) &&
      (keep_order || ordered_)) {
    return;
  }
  analysed_ = false;
  nodes_ = nodes;
  components_ = components;
  resize_with_capacity(edges_, edges.size());
  std::copy(edges.begin(), edges.end(), edges_.begin());
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
  lay_out_fronts();
  find_sources();
  analysed_ = true;
}

Elimination::View Elimination::view() {
  return {fronts_,         rows_.data(),   within_.data(), node_.data(),
          sources_.data(), values_.data(), pivots_.data(), runs_.data()};
}

}  // namespace grainlaw::core
