#include "frame/frame_chain.hpp"

#include "packing/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace grainlaw::core {

namespace {

// Penalties of a chain: straight tight chains make frames that stay closed. A gap of 0.35 R, or
// straying by three radii, costs about half the length more.
constexpr double gap_weight = 1.5;
constexpr double stray_weight = 0.05;

constexpr double unreached = std::numeric_limits<double>::infinity();

// Sites cover the cell, the cell before it and the two after it in each direction.
constexpr int first_cell = -1;
constexpr int cells = 4;

}  // namespace

ChainGraph::ChainGraph(std::vector<double> position, const std::vector<double>& radius,
                       const std::array<double, 4>& h, double largest_gap)
    : position_(std::move(position)), h_(h) {
  const std::size_t n = radius.size();
  mean_radius_ = mean_radius(radius);
  std::vector<NeighbourPair<2>> pairs;
  NeighbourSearch<2>().find(n, position_.data(), radius.data(), h.data(), largest_gap, pairs);
  std::vector<std::vector<Link>> links(n);
  for (const NeighbourPair<2>& pair : pairs) {
    const auto i = static_cast<std::size_t>(pair.i);
    const auto j = static_cast<std::size_t>(pair.j);
    const Point a = position_of({pair.i, {0, 0}});
    const Point b = position_of({pair.j, {pair.shift[0], pair.shift[1]}});
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    const double gap = std::max(0.0, length - radius[i] - radius[j]);
    links[i].push_back({pair.j, {pair.shift[0], pair.shift[1]}, length, gap});
    links[j].push_back({pair.i, {-pair.shift[0], -pair.shift[1]}, length, gap});
  }
  begin_.push_back(0);
  for (const auto& of_particle : links) {
    links_.insert(links_.end(), of_particle.begin(), of_particle.end());
    begin_.push_back(links_.size());
  }
  cost_.assign(n * cells * cells, unreached);
  from_.resize(cost_.size());
}

Point ChainGraph::position_of(const Site& site) const {
  const auto p = static_cast<std::size_t>(site.particle);
  return {position_[p] + h_[0] * site.cell[0] + h_[1] * site.cell[1],
          position_[position_.size() / 2 + p] + h_[2] * site.cell[0] + h_[3] * site.cell[1]};
}

double ChainGraph::off_line(const Point& start, const Point& along, const Point& p) const {
  const double length = std::hypot(along[0], along[1]);
  return std::abs(along[0] * (p[1] - start[1]) - along[1] * (p[0] - start[0])) / length;
}

std::optional<Chain> ChainGraph::shortest(int origin, int direction,
                                          const std::vector<char>& blocked) {
  const auto n = position_.size() / 2;
  const auto number = [&](const Site& site) {
    return static_cast<std::size_t>(site.particle) +
           n * static_cast<std::size_t>(site.cell[0] - first_cell +
                                        cells * (site.cell[1] - first_cell));
  };
  const auto site_of = [&](std::size_t k) {
    const auto cell = static_cast<int>(k / n);
    return Site{static_cast<int>(k % n), {cell % cells + first_cell, cell / cells + first_cell}};
  };
  const Site first{origin, {0, 0}};
  const Site last{origin, {direction == 0 ? 1 : 0, direction == 0 ? 0 : 1}};
  const Point start = position_of(first);
  const Point end = position_of(last);
  const Point along = {end[0] - start[0], end[1] - start[1]};

  // A* bound: no chain costs less than the straight line.
  const auto remaining = [&](const Point& p) { return std::hypot(end[0] - p[0], end[1] - p[1]); };
  using Entry = std::pair<double, std::size_t>;  // cost + remaining, site
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const std::size_t k : touched_) cost_[k] = unreached;
  touched_.assign(1, number(first));
  cost_[number(first)] = 0;
  open.emplace(remaining(start), number(first));
  const std::size_t goal = number(last);
  while (!open.empty() && open.top().second != goal) {
    const auto [estimate, k] = open.top();
    open.pop();
    const Site site = site_of(k);
    const Point here = position_of(site);
    if (estimate > cost_[k] + remaining(here)) continue;  // a cheaper chain was found since
    const auto p = static_cast<std::size_t>(site.particle);
    for (std::size_t l = begin_[p]; l < begin_[p + 1]; ++l) {
      const Link& link = links_[l];
      const Site next{link.to, {site.cell[0] + link.shift[0], site.cell[1] + link.shift[1]}};
      const auto inside = [](int c) { return c >= first_cell && c < first_cell + cells; };
      if (!inside(next.cell[0]) || !inside(next.cell[1])) continue;
      const std::size_t m = number(next);
      if (m != goal &&
          (next.particle == origin || blocked[static_cast<std::size_t>(next.particle)]))
        continue;
      const Point there = position_of(next);
      const double stray = off_line(start, along, there) / mean_radius_;
      const double cost = cost_[k] + link.length * (1 + gap_weight * link.gap / mean_radius_ +
                                                    stray_weight * stray * stray);
      if (cost >= cost_[m]) continue;
      if (cost_[m] == unreached) touched_.push_back(m);
      cost_[m] = cost;
      from_[m] = k;
      open.emplace(cost + remaining(there), m);
    }
  }
  if (open.empty()) return std::nullopt;
  Chain chain{{last}, cost_[goal]};
  for (std::size_t k = goal; k != number(first);) {
    k = from_[k];
    chain.sites.push_back(site_of(k));
  }
  std::reverse(chain.sites.begin(), chain.sites.end());
  return chain;
}

}  // namespace grainlaw::core
