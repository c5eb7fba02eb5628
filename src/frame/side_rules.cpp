#include "frame/side_rules.hpp"

#include "base/error.hpp"
#include "frame/frame.hpp"
#include "frame/rigid_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace grainlaw::core {

namespace {

constexpr std::size_t least_under_stress = 4;
constexpr std::array<const char*, 4> side_names{"bottom", "right", "top", "left"};

[[noreturn]] void wrong(const std::string& message) {
  throw Error(GRAINLAW_BAD_PACKING, "boundary: " + message);
}

// Bits of the sides of every boundary particle: bit k for side k, two at a corner.
std::vector<unsigned char> sides_of_boundary(const Frame& frame) {
  const auto corner = corner_indices(frame);
  const std::size_t count = frame.boundary.size();
  std::vector<unsigned char> sides(count, 0);
  for (std::size_t side = 0; side < 4; ++side) {
    const std::size_t end = side < 3 ? corner[side + 1] : count;
    for (std::size_t q = corner[side]; q <= end; ++q) {
      sides[q % count] |= static_cast<unsigned char>(1U << side);
    }
  }
  return sides;
}

class Builder {
 public:
  Builder(const Packing& packing, const Sides& sides, BoundarySpace<2>& space)
      : packing_(packing),
        frame_(*packing.frame),
        sides_(sides),
        space_(space),
        sides_of_(sides_of_boundary(frame_)) {}

  void build() {
    share_nodes();
    fix_nodes();
    set_rows();
    for (int direction = 0; direction < 2; ++direction) average(direction);
    bind_to_axes();
  }

 private:
  [[nodiscard]] bool any_side(std::size_t index, auto&& has) const {
    for (std::size_t k = 0; k < 4; ++k) {
      if ((sides_of_[index] >> k & 1U) != 0 && has(sides_[k])) return true;
    }
    return false;
  }

  void check_pair(std::size_t one, std::size_t other) const {
    const Side& a = sides_[one];
    const Side& b = sides_[other];
    if (!a.shared() && !b.shared()) return;
    if (a.x != b.x || a.y != b.y || a.rotation != b.rotation) {
      wrong(
          fmt::format("\"P\" and \"periodic\" need the opposite side to be the same, but {} and "
                      "{} differ",
                      side_names[one], side_names[other]));
    }
    const std::size_t k = one == left_side ? 0 : 1;
    if (!frame_.copies[k] || !are_copies_here(k)) {
      wrong(fmt::format("{} and {} are \"P\" or \"periodic\", but are not copies of each other",
                        side_names[one], side_names[other]));
    }
  }

  // Whether side k and its opposite are copies here; copies in the reference may have moved
  // separately since.
  [[nodiscard]] bool are_copies_here(std::size_t k) const {
    if (frame_.reference.empty()) return true;
    const auto n = packing_.size();
    const auto& x = packing_.position;
    const auto& h = packing_.cell;
    for (std::size_t q = 0; q < sides_of_.size(); ++q) {
      if (frame_.partner[q] < 0) continue;
      const auto a = static_cast<std::size_t>(frame_.partner[q]);
      const auto b = static_cast<std::size_t>(frame_.boundary[q]);
      if (frame_.offset[b][k] - frame_.offset[a][k] != 1) continue;
      const double off = std::hypot(x[b] - x[a] - h[k], x[n + b] - x[n + a] - h[2 + k]);
      if (!(off <= 1e-9 * std::hypot(h[k], h[2 + k]))) return false;
    }
    return true;
  }

  // Merges particles of sides that share into one node; nodes are numbered by first appearance.
  void share_nodes() {
    check_pair(left_side, right_side);
    check_pair(bottom_side, top_side);
    space_.copied = {sides_[left_side].shared(), sides_[bottom_side].shared()};
    std::vector<int> first(packing_.size());
    std::iota(first.begin(), first.end(), 0);
    const auto join = [&](int a, int b) {
      const auto root = [&](int p) {
        while (first[static_cast<std::size_t>(p)] != p) p = first[static_cast<std::size_t>(p)];
        return p;
      };
      const int one = root(a);
      const int other = root(b);
      first[static_cast<std::size_t>(std::max(one, other))] = std::min(one, other);
    };
    for (std::size_t q = 0; q < sides_of_.size(); ++q) {
      const bool across = (sides_of_[q] & (1U << left_side | 1U << right_side)) != 0;
      if (frame_.partner[q] >= 0 && space_.copied[across ? 0 : 1]) {
        join(frame_.boundary[q], frame_.partner[q]);
      }
    }
    const auto& c = frame_.corner;
    if (space_.copied[0]) join(c[0], c[1]), join(c[3], c[2]);
    if (space_.copied[1]) join(c[0], c[3]), join(c[1], c[2]);
    space_.node.resize(packing_.size());
    space_.nodes = 0;
    for (std::size_t p = 0; p < packing_.size(); ++p) {
      const auto root = static_cast<std::size_t>(first[p]);
      space_.node[p] = root == p ? static_cast<int>(space_.nodes++)
                                 : space_.node[static_cast<std::size_t>(first[root])];
    }
  }

  [[nodiscard]] std::size_t node_at(std::size_t index) const {
    return static_cast<std::size_t>(space_.node[static_cast<std::size_t>(frame_.boundary[index])]);
  }

  void fix_nodes() {
    space_.fixed.assign(space_.nodes, 0);
    space_.boundary.assign(space_.nodes, 0);
    for (std::size_t q = 0; q < sides_of_.size(); ++q) {
      auto& fixed = space_.fixed[node_at(q)];
      const auto prescribes_rotation = [](const Side& s) {
        return s.rotation != SideRotation::free;
      };
      auto& boundary = space_.boundary[node_at(q)];
      boundary = any_side(q, prescribes_rotation) || boundary == 1 ? 1 : 2;
      const auto fix = [&](unsigned char bit, auto&& has) {
        if (any_side(q, has)) fixed |= bit;
      };
      const auto fixes_x = [](const Side& s) {
        return s.x == SideRule::d || s.row == SideRow::rigid;
      };
      const auto fixes_y = [](const Side& s) {
        return s.y == SideRule::d || s.row == SideRow::rigid;
      };
      fix(fixed_bit(0), fixes_x);
      fix(fixed_bit(1), fixes_y);
      fix(fixed_rotation<2>, [](const Side& s) { return s.rotation == SideRotation::fixed; });
    }
    if (space_.options.inner_rotation == InnerRotation::fixed) {
      for (std::size_t q = 0; q < space_.nodes; ++q)
        if (space_.boundary[q] == 0) space_.fixed[q] |= fixed_rotation<2>;
    }
    // Nodes periodic in both directions translate freely; the published servo prescribes the
    // corners.
    for (int direction = 0; direction < 2; ++direction) {
      const auto shared = [&](SideName side) {
        return sides_[side].rule(direction) == SideRule::p;
      };
      if (!shared(left_side) || !shared(bottom_side)) continue;
      const int corner = frame_.corner[0];
      if (space_.options.method == BoundaryMethod::servo) {
        const auto node = static_cast<std::size_t>(space_.node[static_cast<std::size_t>(corner)]);
        space_.fixed[node] |= fixed_bit(static_cast<std::size_t>(direction));
      } else {
        space_.anchor[static_cast<std::size_t>(direction)] = corner;
      }
    }
  }

  void set_rows() {
    for (std::size_t k = 0; k < 4; ++k) {
      if (sides_[k].row == SideRow::discs) continue;
      if (space_.rows.empty()) space_.rows.assign(packing_.size(), 0);
      for (std::size_t q = 0; q < sides_of_.size(); ++q) {
        if ((sides_of_[q] >> k & 1U) == 0) continue;
        space_.rows[static_cast<std::size_t>(frame_.boundary[q])] |=
            static_cast<unsigned char>(1U << k);
      }
    }
  }

  // Gram-Schmidt on the two components of A over the nodes that are free under stress.
  void average(int direction) {
    constexpr double dependent = 1e-8;  // relative to the length of A
    auto& average = space_.average[static_cast<std::size_t>(direction)];
    const unsigned char bit = fixed_bit(static_cast<std::size_t>(direction));
    std::vector<std::array<double, 2>> area(space_.nodes, {0, 0});
    std::vector<char> free(space_.nodes, 0);
    std::size_t particles = 0;
    for (std::size_t q = 0; q < sides_of_.size(); ++q) {
      const std::size_t node = node_at(q);
      const auto under_stress = [=](const Side& s) { return s.rule(direction) == SideRule::t; };
      if ((space_.fixed[node] & bit) != 0 || !any_side(q, under_stress)) continue;
      ++particles;
      free[node] = 1;
      for (std::size_t k = 0; k < 2; ++k) area[node][k] += frame_.area[q][k];
    }
    if (particles == 0) return;
    if (particles < least_under_stress) {
      wrong(fmt::format("\"T\" holds {} particles in {}, expected at least {}", particles,
                        direction == 0 ? 'x' : 'y', least_under_stress));
    }
    for (std::size_t q = 0; q < space_.nodes; ++q) {
      if (!free[q]) continue;
      average.node.push_back(static_cast<std::int32_t>(q));
      average.row.push_back({0, 0});
    }
    double length = 0;
    for (const auto& a : area) length += a[0] * a[0] + a[1] * a[1];
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<double> column;
      for (const auto q : average.node) column.push_back(area[static_cast<std::size_t>(q)][k]);
      double norm = std::inner_product(column.begin(), column.end(), column.begin(), 0.0);
      for (int twice = 0; twice < 2 && average.rows > 0; ++twice) {
        double along = 0;
        for (std::size_t p = 0; p < column.size(); ++p) along += column[p] * average.row[p][0];
        for (std::size_t p = 0; p < column.size(); ++p) column[p] -= along * average.row[p][0];
        norm = std::inner_product(column.begin(), column.end(), column.begin(), 0.0);
      }
      if (!(norm > dependent * dependent * length)) continue;
      for (std::size_t p = 0; p < column.size(); ++p) {
        average.row[p][average.rows] = column[p] / std::sqrt(norm);
      }
      ++average.rows;
    }
  }

  void bind_to_axes() {
    const auto differs = [](const Side& side) {
      return side.x != side.y || side.row == SideRow::rigid;
    };
    if (!space_.finds_deformation && std::none_of(sides_.begin(), sides_.end(), differs)) return;
    space_.reference = undeformed(packing_);
    space_.offset.assign(2 * packing_.size(), 0.0);
    for (std::size_t k = 0; k < 4; ++k) {
      if (sides_[k].row == SideRow::rigid) straighten(packing_, k, space_);
    }
    if (!frame_.reference.empty()) carry_along(frame_.deformation);
  }

  // Carries the reference along by F; discs keep their distance from the row.
  void carry_along(const std::array<double, 4>& f) {
    const auto n = packing_.size();
    double* x = space_.reference.data();
    double* y = x + n;
    for (std::size_t p = 0; p < n; ++p) {
      const double a = x[p];
      const double b = y[p];
      x[p] = f[0] * a + f[1] * b;
      y[p] = f[2] * a + f[3] * b;
    }
  }

  const Packing& packing_;
  const Frame& frame_;
  const Sides& sides_;
  BoundarySpace<2>& space_;
  std::vector<unsigned char> sides_of_;
};

}  // namespace

void space_of_sides(const Packing& packing, const Sides& sides, BoundarySpace<2>& space) {
  Builder(packing, sides, space).build();
}

}  // namespace grainlaw::core
