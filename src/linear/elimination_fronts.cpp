// Fronts of the elimination, their memory, and the positions of the matrix blocks in them.
#include "linear/dense_panels.hpp"
#include "linear/elimination.hpp"

#include "base/capacity.hpp"

#include <algorithm>
#include <array>

namespace grainlaw::core {

namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

}  // namespace

// Finds the fronts: columns of one list. A front and its parent right after it merge where the
// zeros that this adds cost less than a second front.
void Elimination::find_fronts() {
  const auto goes_on = [&](std::size_t j) {
    return parent_[j - 1] == static_cast<std::int32_t>(j) && below_[j - 1] == below_[j] + 1;
  };
  fronts_.clear();
  // The last front comes first, so that the next one is already merged.
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
  keep_capacity(fronts_);
  std::reverse(fronts_.begin(), fronts_.end());
}

// Sorts the others of every front and finds their indices in the parent.
void Elimination::link_fronts() {
  resize_with_capacity(front_of_, nodes_);
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
  keep_capacity(rows_);
  resize_with_capacity(within_, rows_.size());
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    front.parent = front.others == 0 ? -1 : front_of_[at(rows_[front.rows])];
    if (front.parent == -1) continue;
    Front& parent = fronts_[at(front.parent)];
    front.opens = parent.is_leaf;
    parent.is_leaf = false;
    const std::size_t end = parent.first + parent.pivots;
    std::size_t index = parent.rows;
    for (std::size_t k = front.rows; k < front.rows + front.others; ++k) {
      if (at(rows_[k]) < end) {
        within_[k] = static_cast<std::int32_t>(at(rows_[k]) - parent.first);
        ++front.passed;
        continue;
      }
      while (rows_[index] != rows_[k]) ++index;
      within_[k] = static_cast<std::int32_t>(parent.pivots + index - parent.rows);
    }
  }
}

// Places the fronts in memory. Schur complements lie on two stacks by their depth in the tree: that
// of a child and that of its parent are each on top.
void Elimination::lay_out_fronts() {
  const auto b = static_cast<std::size_t>(components_);
  resize_with_capacity(mark_, std::max(nodes_, fronts_.size()));
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
  // Registers reach beyond the last block.
  resize_with_capacity(runs_, most);
  resize_with_capacity(pivots_, nodes_);
  resize_with_capacity(values_, slot + highest[0] + highest[1] + dense::group);
}

// Finds the positions of the matrix blocks, front by front.
void Elimination::find_sources() {
  const auto b = static_cast<std::size_t>(components_);
  const auto for_each = [&](auto&& visit) {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const std::int32_t p = position_[at(edges_[e].first)];
      const std::int32_t q = position_[at(edges_[e].second)];
      visit(e, std::min(p, q), std::max(p, q), p < q);
    }
  };
  resize_with_capacity(next_, std::max(nodes_, fronts_.size()));
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
  resize_with_capacity(sources_, source + ahead);
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
    sources_[next_[f]++] = {front.values + shape.offset(pivot, other), shape.pivot_rows,
                            ascending ? upper : lower};
    sources_[next_[f]++] = {front.values + shape.offset(other, pivot),
                            other < front.pivots ? shape.pivot_rows : shape.other_rows,
                            ascending ? lower : upper};
  });
}

}  // namespace grainlaw::core
