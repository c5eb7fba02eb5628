#include "equilibrium/stiffness.hpp"

#include "contact/frictional.hpp"
#include "room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw {

namespace {

// Contacts with a smaller gap than this, in radii, are kept in the graph although they carry
// nothing, so that it lasts while they open and close.
constexpr double graph_gap = 1e-3;
// Holds rattlers and the translation of the cell in the factors, relative to the masses; refinement
// takes it out of the solution again.
constexpr double grounding = 1e-9;

std::array<double, 9> product(const std::array<double, 9>& a, const std::array<double, 9>& b) {
  std::array<double, 9> c{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 3; ++j) c[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    }
  }
  return c;
}

}  // namespace

ContactMap contact_map(double nx, double ny, double lever) {
  return {{-nx, ny, 0, -ny, -nx, 0, 0, 0, -lever},
          {nx, -ny, 0, ny, nx, 0, 0, 0, lever - 1},
          {-nx, -ny, 0, ny, -nx, 0, 0, 0, lever},
          {nx, ny, 0, -ny, nx, 0, 0, 0, 1 - lever}};
}

void Stiffness::find_graph(const Increment& increment) {
  const auto& list = increment.contacts;
  const auto& node = increment.problem->space->node;
  pairs_.clear();
  resize_with_room(edge_of_contact_, list.size());
  std::fill(edge_of_contact_.begin(), edge_of_contact_.end(), -2);
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (increment.overlap(c) < -0.5 * graph_gap * list.reach[c]) continue;
    const auto [a, b] = std::minmax(node[static_cast<std::size_t>(list.i[c])],
                                    node[static_cast<std::size_t>(list.j[c])]);
    edge_of_contact_[c] = -1;  // a node with itself
    if (a != b) pairs_.push_back({{a, b}, static_cast<std::int32_t>(c)});
  }
  keep_room(pairs_);
  std::sort(pairs_.begin(), pairs_.end());
  graph_.clear();
  for (const auto& [edge, c] : pairs_) {
    if (graph_.empty() || graph_.back() != edge) graph_.push_back(edge);
    edge_of_contact_[static_cast<std::size_t>(c)] = static_cast<std::int32_t>(graph_.size()) - 1;
  }
  keep_room(graph_);
  matrix_.reset(increment.nodes(), increment.problem->components(), graph_);
}

void Stiffness::assemble(const Increment& increment, double shift) {
  factorised_ = false;
  find_graph(increment);
  const auto& list = increment.contacts;
  const auto& space = *increment.problem->space;
  const auto& law = *increment.problem->law;
  const auto b = static_cast<std::size_t>(matrix_.components);
  const auto s = static_cast<std::size_t>(matrix_.stride);
  const auto size = matrix_.block_size();
  const auto nodes = increment.nodes();

  const auto subtract = [&](double* block, const std::array<double, 9>& value) {
    for (std::size_t column = 0; column < b; ++column) {
      for (std::size_t row = 0; row < b; ++row) block[column * s + row] -= value[3 * row + column];
    }
  };
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (edge_of_contact_[c] == -2) continue;
    const auto point =
        contact_point(list, c, increment.coordinates, increment.particles(), increment.cell, law);
    if (point.status == ContactStatus::open) continue;
    const auto stiffness = contact_stiffness(point, list.normal_stiffness[c],
                                             list.tangential_stiffness[c], law.friction);
    const auto map = contact_map(point.normal_x, point.normal_y, list.lever_i[c]);
    const auto by_i = product(stiffness, map.motion_i);
    const auto by_j = product(stiffness, map.motion_j);
    const auto i = static_cast<std::size_t>(space.node[static_cast<std::size_t>(list.i[c])]);
    const auto j = static_cast<std::size_t>(space.node[static_cast<std::size_t>(list.j[c])]);
    double* ii = matrix_.diagonal.data() + i * size;
    double* jj = matrix_.diagonal.data() + j * size;
    subtract(ii, product(map.force_i, by_i));
    subtract(jj, product(map.force_j, by_j));
    if (i == j) {
      subtract(ii, product(map.force_i, by_j));
      subtract(ii, product(map.force_j, by_i));
      continue;
    }
    const auto e = static_cast<std::size_t>(edge_of_contact_[c]);
    double* ij = (i < j ? matrix_.upper : matrix_.lower).data() + e * size;
    double* ji = (i < j ? matrix_.lower : matrix_.upper).data() + e * size;
    subtract(ij, product(map.force_i, by_j));
    subtract(ji, product(map.force_j, by_i));
  }

  add_masses(increment, shift);
  if (space.identity) return;
  const auto clear = [&](double* block, bool rows) {
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t l = 0; l < b; ++l) block[rows ? l * s + k : k * s + l] = 0;
    }
  };
  for (std::size_t q = 0; q < nodes; ++q) {
    if (!space.fixed[q]) continue;
    double* block = matrix_.diagonal.data() + q * size;
    clear(block, true);
    clear(block, false);
    block[0] = block[s + 1] = 1;
  }
  for (std::size_t e = 0; e < graph_.size(); ++e) {
    const bool first = space.fixed[static_cast<std::size_t>(graph_[e].first)] != 0;
    const bool second = space.fixed[static_cast<std::size_t>(graph_[e].second)] != 0;
    double* upper = matrix_.upper.data() + e * size;
    double* lower = matrix_.lower.data() + e * size;
    if (first) clear(upper, true);
    if (first) clear(lower, false);
    if (second) clear(upper, false);
    if (second) clear(lower, true);
  }
}

void Stiffness::add_masses(const Increment& increment, double factor) {
  const auto nodes = increment.nodes();
  const auto b = static_cast<std::size_t>(matrix_.components);
  const auto s = static_cast<std::size_t>(matrix_.stride);
  for (std::size_t q = 0; q < nodes; ++q) {
    double* block = matrix_.diagonal.data() + q * matrix_.block_size();
    for (std::size_t k = 0; k < b; ++k) {
      block[k * s + k] += factor * increment.mass[k * nodes + q];
    }
  }
}

void Stiffness::factorise(Increment& increment) {
  ++increment.factorisations;
  lu_.analyse(matrix_);
  add_masses(increment, grounding);
  factorised_ = lu_.factorise(matrix_);
  add_masses(increment, -grounding);
  check_.resize(increment.unknowns());
  correction_.resize(increment.unknowns());
}

bool Stiffness::solve(const Increment& increment, std::span<const double> b, std::span<double> x) {
  constexpr double good = 1e-12;
  constexpr double usable = 1e-6;
  double scale = std::numeric_limits<double>::min();
  for (const double value : b) scale = std::max(scale, std::abs(value));
  const auto defect = [&] {
    matrix_.multiply(x, check_);
    double largest = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      check_[k] = b[k] - check_[k];
      largest =
          std::max(largest, std::isfinite(check_[k]) ? std::abs(check_[k])
                                                     : std::numeric_limits<double>::infinity());
    }
    return largest / scale;
  };
  if (factorised_) {
    lu_.solve(b, x);
    double error = defect();
    for (double last = 4 * error; error > good && error < 0.5 * last;) {
      lu_.solve(check_, correction_);
      for (std::size_t k = 0; k < x.size(); ++k) x[k] += correction_[k];
      last = error;
      error = defect();
    }
    if (error <= usable) return true;
  }
  add_masses(increment, grounding);
  const bool solved = solve_with_pivoting(matrix_, b, x);
  add_masses(increment, -grounding);
  return solved && defect() <= usable;
}

}  // namespace grainlaw
