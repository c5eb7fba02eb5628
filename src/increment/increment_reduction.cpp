// What a boundary space makes of forces: the parts of Increment that a periodic cell does not use.
#include "increment/increment.hpp"

#include <algorithm>

namespace grainlaw::core {

template <int D>
void Increment<D>::reduce(std::span<ForceRecord<D>> residual) const {
  const auto& space = *problem->space;
  if (space.identity) return;
  constexpr std::size_t components = Dimension<D>::unknowns;
  for (std::size_t q = 0; q < nodes(); ++q) {
    const unsigned char fixed = space.fixed[q];
    if (fixed == 0) continue;
    for (std::size_t k = 0; k < components; ++k) {
      if ((fixed & fixed_bit(k)) != 0) (&residual[q].x)[k] = 0;
    }
  }
  if constexpr (D == 2) {
    if (space.averages()) average_masses_.take_out(space, mass_records, residual);
  }
  if (!space.finds_deformation) return;
  // V (P* - P) with V P = - sum f (x) L.
  Tensor<D> force{};
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const double* f = &contacts.forces[c].x;
    if (std::all_of(f, f + dim, [](double component) { return component == 0; })) continue;
    const auto branch = fixed_branch(c);
    for (std::size_t k = 0; k < squared<D>; ++k) force[k] += f[k / dim] * branch[k % dim];
  }
  for (std::size_t k = 0; k < squared<D>; ++k) {
    force[k] = space.found[k]
                   ? (force[k] + space.reference_volume * space.stress[k]) / deformation_scale_
                   : 0;
  }
  for (std::size_t i = 0; i < dim; ++i) {
    residual[nodes() + i] = {};
    std::copy_n(force.data() + dim * i, dim, &residual[nodes() + i].x);
  }
}

template <int D>
Vec<D> Increment<D>::fixed_branch(std::size_t c) const {
  const auto n = particles();
  const auto i = static_cast<std::size_t>(contacts.i[c]);
  const auto j = static_cast<std::size_t>(contacts.j[c]);
  Vec<D> result{};
  for (std::size_t k = 0; k < dim; ++k) {
    const double* x = problem->space->reference.data() + k * n;
    result[k] = x[j] - x[i];
  }
  return result;
}

template <int D>
void Increment<D>::change_deformation(const double* rows, std::vector<ParticleRecord<D>>& moved) {
  const auto& space = *problem->space;
  const auto n = particles();
  constexpr std::size_t lanes = Dimension<D>::lanes;
  Tensor<D> change{};
  for (std::size_t k = 0; k < squared<D>; ++k) {
    if (space.found[k]) change[k] = rows[lanes * (k / dim) + k % dim] / deformation_scale_;
    deformation[k] += change[k];
  }
  const double* x = space.reference.data();
  for (std::size_t p = 0; p < n; ++p) {
    for (std::size_t k = 0; k < dim; ++k) {
      (&moved[p].x)[k] += dot<D>(change.data() + dim * k, x + p, n);
    }
  }
}

template <int D>
int Increment<D>::released_particle() {
  const auto& space = *problem->space;
  held_.assign(nodes(), 0);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (overlap(c) <= 0) continue;
    held_[static_cast<std::size_t>(space.node[static_cast<std::size_t>(contacts.i[c])])] = 1;
    held_[static_cast<std::size_t>(space.node[static_cast<std::size_t>(contacts.j[c])])] = 1;
  }
  for (const auto& average : space.average) {
    for (const auto q : average.node) {
      if (held_[static_cast<std::size_t>(q)]) continue;
      return static_cast<int>(std::find(space.node.begin(), space.node.end(), q) -
                              space.node.begin());
    }
  }
  return -1;
}

template <int D>
bool Increment<D>::collapsed() {
  if (!problem->space->averages()) return false;
  return mean_force < problem->force_floor || released_particle() >= 0;
}

template class Increment<2>;
template class Increment<3>;

}  // namespace grainlaw::core
