#include "homogenise/kinetic_stress.hpp"

#include "increment/particle_masses.hpp"

namespace grainlaw::core {

namespace {

template <int D>
bool has_kinetic_stress(const Increment<D>& increment) {
  return increment.motion().drag().has_inertia() && !increment.problem().space->bound_to_axes();
}

template <int D>
Vec<D> end_velocity(const Drag<D>& drag, std::size_t q) {
  Vec<D> v{};
  for (std::size_t k = 0; k < D; ++k) v[k] = drag.end_velocity(q, k);
  return v;
}

}  // namespace

template <int D>
void add_kinetic_stress(const Increment<D>& increment, Tensor<D>& stress) {
  if (!has_kinetic_stress(increment)) return;
  const auto& drag = increment.motion().drag();
  const Tensor<D> back = inverse<D>(increment.motion().deformation());
  for (std::size_t q = 0; q < increment.problem().nodes(); ++q) {
    const Vec<D> v = end_velocity(drag, q);
    const Vec<D> reference = product<D>(back, v);
    const double share = drag.mass(q) / increment.problem().space->reference_volume;
    for (std::size_t i = 0; i < D; ++i) {
      for (std::size_t j = 0; j < D; ++j) stress[D * i + j] -= share * v[i] * reference[j];
    }
  }
}

template <int D>
void add_kinetic_changes(const Increment<D>& increment, const Sensitivity<D>& sensitivity,
                         std::size_t lanes, Tensor4<D>& tangent) {
  if (!has_kinetic_stress(increment)) return;
  const auto& motion = increment.motion();
  const auto& drag = motion.drag();
  const auto b = static_cast<std::size_t>(increment.problem().components());
  const Tensor<D> back = inverse<D>(motion.deformation());
  const Tensor<D> carry = transpose<D>(inverse<D>(motion.part_deformation()));
  for (std::size_t q = 0; q < increment.problem().nodes(); ++q) {
    const Vec<D> v = end_velocity(drag, q);
    const Vec<D> reference = product<D>(back, v);
    const auto excess = drag.carried_excess(q, motion.records());
    const auto free = drag.free_velocity(q, motion.records());
    Vec<D> distance{}, both{};
    for (std::size_t k = 0; k < D; ++k) {
      distance[k] = component(excess, k);
      both[k] = component(drag.velocity(q), k) + component(free, k);
    }
    const Vec<D> carried = product<D>(carry, both);
    const double share = drag.mass(q) / increment.problem().space->reference_volume;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      Tensor<D> dF{};
      for (std::size_t k = 0; k < squared<D>; ++k)
        dF[k] = sensitivity.deformation_change()[k].lane[lane];
      const Tensor<D> rate = product<D>(dF, back);
      Vec<D> of_free = product<D>(rate, distance);
      for (std::size_t k = 0; k < D; ++k) {
        of_free[k] += sensitivity.motion()[q * b + k].lane[lane];
        of_free[k] *= drag.velocity_by_excess();
      }
      const Vec<D> of_carry = product<D>(transpose<D>(rate), carried);
      Vec<D> dv = product<D>(carry, of_free);
      for (std::size_t k = 0; k < D; ++k) dv[k] = 0.5 * (of_free[k] + dv[k] - of_carry[k]);
      const Vec<D> stretched = product<D>(dF, reference);
      Vec<D> change{};
      for (std::size_t k = 0; k < D; ++k) change[k] = dv[k] - stretched[k];
      const Vec<D> of_reference = product<D>(back, change);
      for (std::size_t i = 0; i < D; ++i) {
        for (std::size_t j = 0; j < D; ++j) {
          tangent[(D * i + j) * squared<D> + lane] -=
              share * (dv[i] * reference[j] + v[i] * of_reference[j]);
        }
      }
    }
  }
}

template <int D>
double kinetic_energy(const Problem<D>& problem, const Configuration<D>& at) {
  if (!problem.inertia || at.velocity.empty()) return 0;
  std::vector<MassRecord<D>> mass;
  find_particle_masses(*problem.packing, *problem.space, mass);
  const std::size_t n = problem.particles();
  std::vector<char> seen(problem.nodes(), 0);
  double energy = 0;
  for (std::size_t p = 0; p < n; ++p) {
    const auto q = static_cast<std::size_t>(problem.space->node[p]);
    if (seen[q]++ != 0) continue;
    for (std::size_t k = 0; k * n < at.velocity.size(); ++k) {
      const double velocity = (k < D ? 1 : problem.packing->radius[p]) * at.velocity[k * n + p];
      energy += 0.5 * component(mass[q], k) * velocity * velocity;
    }
  }
  return energy;
}

#define GRAINLAW_FOR(D)                                                                      \
  template void add_kinetic_stress(const Increment<D>&, Tensor<D>&);                         \
  template void add_kinetic_changes(const Increment<D>&, const Sensitivity<D>&, std::size_t, \
                                    Tensor4<D>&);                                            \
  template double kinetic_energy(const Problem<D>&, const Configuration<D>&);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core
