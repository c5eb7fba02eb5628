#include "tangent/bordered_system.hpp"

#include "base/capacity.hpp"
#include "increment/contact_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainlaw::core {

void BorderedSystem::find_columns(const BoundarySpace<2>& space) {
  size_ = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t r = 0; r < space.average[i].rows; ++r) {
      columns_[size_++] = {Kind::average, i, r};
      columns_[size_++] = {Kind::anchors, i, r};
    }
  }
  for (std::size_t k = 0; k < 4; ++k) {
    if (space.found[k]) columns_[size_++] = {Kind::deformation, k, 0};
  }
}

// Sets the columns of a group as right-hand sides, and the residual after the last of them.
void BorderedSystem::set_right_side(const Increment<2>& increment, const Stiffness<2>& stiffness,
                                    std::size_t group, std::span<const double> residual) {
  const auto& space = *increment.problem().space;
  const auto nodes = increment.problem().nodes();
  const std::size_t b = increment.problem().node_unknowns() / nodes;
  std::fill(right_.begin(), right_.end(), ByDeformation<2>{});
  DeformationChange<2> change{};
  const std::size_t first = group * lanes;
  const std::size_t last = std::min(first + lanes, size_);
  for (std::size_t c = first; c < last; ++c) {
    if (columns_[c].kind == Kind::deformation) {
      change[columns_[c].direction].lane[c - first] = 1 / increment.motion().deformation_scale();
    }
  }
  if (space.finds_deformation) add_residual_changes<2>(increment, stiffness, change, {}, right_);
  for (std::size_t c = first; c < last; ++c) {
    const auto& column = columns_[c];
    if (column.kind == Kind::deformation) continue;
    const auto& average = space.average[column.direction];
    const double mean = column.mean(average);
    for (std::size_t k = 0; k < average.node.size(); k += column.stride(average)) {
      const auto q = static_cast<std::size_t>(average.node[k]);
      right_[q * b + column.direction].lane[c - first] = average.row[k][column.row] - mean;
    }
  }
  if (!residual.empty() && size_ >= first && size_ < first + lanes) {
    for (std::size_t q = 0; q < nodes; ++q) {
      for (std::size_t k = 0; k < b; ++k) {
        right_[q * b + k].lane[size_ - first] = residual[k * nodes + q];
      }
    }
  }
  for (std::size_t q = 0; q < nodes; ++q) {
    for (std::size_t k = 0; k < b; ++k) {
      if ((space.fixed[q] >> k & 1U) != 0) right_[q * b + k] = {};
    }
  }
}

// Averages of the motions, and changes of V P / scale.
BorderedSystem::Values BorderedSystem::values_of(const Increment<2>& increment,
                                                 std::span<const TouchingContact<2>> touching,
                                                 std::span<const ContactChange<2>> changes,
                                                 std::span<const ByDeformation<2>> motion) const {
  const auto& space = *increment.problem().space;
  const std::size_t b = increment.problem().node_unknowns() / increment.problem().nodes();
  Values values{};
  for (std::size_t f = 0; f < size_; ++f) {
    const auto& column = columns_[f];
    if (column.kind == Kind::deformation) continue;
    const auto& average = space.average[column.direction];
    const double mean = column.mean(average);
    for (std::size_t k = 0; k < average.node.size(); k += column.stride(average)) {
      const auto& z = motion[static_cast<std::size_t>(average.node[k]) * b + column.direction];
      for (std::size_t l = 0; l < lanes; ++l) {
        values[f].lane[l] += (average.row[k][column.row] - mean) * z.lane[l];
      }
    }
  }
  if (!space.finds_deformation) return values;
  for (std::size_t c = 0; c < touching.size(); ++c) {
    const auto branch = fixed_branch_of(increment, touching[c].index);
    for (std::size_t f = 0; f < size_; ++f) {
      const auto& column = columns_[f];
      if (column.kind != Kind::deformation) continue;
      const double length = branch[column.direction % 2] / increment.motion().deformation_scale();
      const ByDeformation<2>& force =
          column.direction < 2 ? changes[c].force[0] : changes[c].force[1];
      for (std::size_t l = 0; l < lanes; ++l) values[f].lane[l] -= force.lane[l] * length;
    }
  }
  return values;
}

bool BorderedSystem::respond(Increment<2>& increment, Stiffness<2>& stiffness, double shift,
                             std::span<const double> residual) {
  const auto& space = *increment.problem().space;
  find_columns(space);
  const std::size_t count = size_ + (residual.empty() ? 0 : 1);
  resize_with_capacity(right_, increment.problem().node_unknowns());
  const auto touching = stiffness.touching();
  for (std::size_t group = 0; group * lanes < count; ++group) {
    auto& response = response_[group];
    resize_with_capacity(response, right_.size());
    set_right_side(increment, stiffness, group, residual);
    if (!stiffness.solve_together(increment, right_, response)) return false;
    DeformationChange<2> change{};
    const std::size_t first = group * lanes;
    for (std::size_t c = first; c < std::min(first + lanes, size_); ++c) {
      if (columns_[c].kind != Kind::deformation) continue;
      change[columns_[c].direction].lane[c - first] = 1 / increment.motion().deformation_scale();
    }
    if (space.finds_deformation) {
      resize_with_capacity(changes_, touching.size());
      find_contact_changes<2>(increment, touching, change, {}, response, changes_);
    }
    const auto values = values_of(increment, touching, changes_, response);
    for (std::size_t f = 0; f < size_; ++f) {
      for (std::size_t c = first; c < std::min(first + lanes, count); ++c) {
        matrix_[f][c] = values[f].lane[c - first];
      }
    }
  }
  for (std::size_t f = 0; f < size_; ++f) {
    // Columns of anchors apply the load that kn times their average gives.
    if (columns_[f].kind == Kind::anchors) matrix_[f][f] -= 1 / increment.masses().mean_stiffness();
    if (columns_[f].kind != Kind::deformation) continue;
    const std::size_t row = increment.problem().node_unknowns() + columns_[f].direction;
    matrix_[f][f] += shift * increment.masses().of_unknowns()[row];
  }
  return true;
}

// Replaces values by -matrix^-1 values, by elimination with row pivots.
bool BorderedSystem::eliminate(Values& values) const {
  auto m = matrix_;
  for (std::size_t c = 0; c < size_; ++c) {
    std::size_t pivot = c;
    for (std::size_t f = c + 1; f < size_; ++f) {
      if (std::abs(m[f][c]) > std::abs(m[pivot][c])) pivot = f;
    }
    if (!(std::abs(m[pivot][c]) > 0) || !std::isfinite(m[pivot][c])) return false;
    std::swap(m[c], m[pivot]);
    std::swap(values[c], values[pivot]);
    for (std::size_t f = c + 1; f < size_; ++f) {
      const double factor = m[f][c] / m[c][c];
      for (std::size_t k = c; k < size_; ++k) m[f][k] -= factor * m[c][k];
      for (std::size_t l = 0; l < lanes; ++l) values[f].lane[l] -= factor * values[c].lane[l];
    }
  }
  for (std::size_t c = size_; c-- > 0;) {
    for (std::size_t l = 0; l < lanes; ++l) {
      double sum = -values[c].lane[l];
      for (std::size_t k = c + 1; k < size_; ++k) sum -= m[c][k] * values[k].lane[l];
      values[c].lane[l] = sum / m[c][c];
    }
  }
  return true;
}

bool BorderedSystem::solve(Increment<2>& increment, Stiffness<2>& stiffness, double shift,
                           std::span<const double> residual, std::span<double> step) {
  if (!respond(increment, stiffness, shift, residual)) return false;
  Values values{};
  for (std::size_t f = 0; f < size_; ++f) {
    values[f].lane[0] = matrix_[f][size_];
    if (columns_[f].kind != Kind::deformation) continue;
    values[f].lane[0] -= residual[increment.problem().node_unknowns() + columns_[f].direction];
  }
  if (!eliminate(values)) return false;
  const auto nodes = increment.problem().nodes();
  const std::size_t b = increment.problem().node_unknowns() / nodes;
  const auto response = [&](std::size_t column, std::size_t row) {
    return response_[column / lanes][row].lane[column % lanes];
  };
  for (std::size_t q = 0; q < nodes; ++q) {
    for (std::size_t k = 0; k < b; ++k) {
      double sum = response(size_, q * b + k);
      for (std::size_t c = 0; c < size_; ++c) sum += values[c].lane[0] * response(c, q * b + k);
      step[k * nodes + q] = sum;
    }
  }
  const std::size_t rows = increment.problem().node_unknowns();
  std::fill(step.begin() + static_cast<std::ptrdiff_t>(rows), step.end(), 0.0);
  for (std::size_t c = 0; c < size_; ++c) {
    if (columns_[c].kind != Kind::deformation) continue;
    step[rows + columns_[c].direction] = values[c].lane[0];
  }
  return true;
}

bool BorderedSystem::prepare(Increment<2>& increment, Stiffness<2>& stiffness) {
  return respond(increment, stiffness, 0, {});
}

bool BorderedSystem::complete(const Increment<2>& increment,
                              std::span<const TouchingContact<2>> touching,
                              std::span<const ContactChange<2>> changes,
                              std::span<ByDeformation<2>> motion, DeformationChange<2>& change) {
  auto values = values_of(increment, touching, changes, motion);
  if (!eliminate(values)) return false;
  for (std::size_t c = 0; c < size_; ++c) {
    for (std::size_t k = 0; k < motion.size(); ++k) {
      const double response = response_[c / lanes][k].lane[c % lanes];
      for (std::size_t l = 0; l < lanes; ++l) motion[k].lane[l] += values[c].lane[l] * response;
    }
    if (columns_[c].kind != Kind::deformation) continue;
    for (std::size_t l = 0; l < lanes; ++l) {
      change[columns_[c].direction].lane[l] =
          values[c].lane[l] / increment.motion().deformation_scale();
    }
  }
  return true;
}

}  // namespace grainlaw::core
