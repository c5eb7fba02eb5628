#include "homogenise/stress.hpp"

#include "contact/contact_point.hpp"
#include "homogenise/kinetic_stress.hpp"
#include "increment/contact_state.hpp"

#include <cmath>

namespace grainlaw::core {

namespace {

// Calls visit(contact, point, L) for every touching contact, L = F^-1 l.
template <int D, class Visit>
void for_each_contact(const Increment<D>& increment, Visit&& visit) {
  const Tensor<D> pull_back = inverse<D>(increment.motion().deformation());
  for (std::size_t c = 0; c < increment.contacts().size(); ++c) {
    const auto point = contact_point(increment.contacts(), c, increment.motion().coordinates(),
                                     increment.problem().particles(), *increment.problem().law);
    if (point.status == ContactStatus::open) continue;
    visit(c, point,
          increment.problem().space->bound_to_axes() ? fixed_branch_of(increment, c)
                                                     : product<D>(pull_back, point.branch));
  }
}

// Zeroes rows and columns of found components: their stress is prescribed, and the F given for them
// is ignored.
template <int D>
void clear_found(const BoundarySpace<D>& space, Tensor4<D>& tangent) {
  constexpr std::size_t n = squared<D>;
  for (std::size_t k = 0; k < n; ++k) {
    if (!space.found[k]) continue;
    for (std::size_t m = 0; m < n; ++m) tangent[n * k + m] = tangent[n * m + k] = 0;
  }
}

// Condenses a tangent at fixed F: found components of F change so that the prescribed stresses
// stay.
template <int D>
void condense_found(const BoundarySpace<D>& space, Tensor4<D>& tangent) {
  constexpr std::size_t n = squared<D>;
  for (std::size_t k = 0; k < n; ++k) {
    if (!space.found[k]) continue;
    const double pivot = tangent[(n + 1) * k];
    if (pivot != 0) {
      for (std::size_t m = 0; m < n; ++m) {
        if (m == k) continue;
        const double factor = tangent[n * m + k] / pivot;
        for (std::size_t l = 0; l < n; ++l) tangent[n * m + l] -= factor * tangent[n * k + l];
      }
    }
    for (std::size_t m = 0; m < n; ++m) tangent[n * k + m] = tangent[n * m + k] = 0;
  }
}

}  // namespace

template <int D>
Tensor<D> piola_stress(const Increment<D>& increment) {
  Tensor<D> p{};
  const double volume = increment.problem().space->reference_volume;
  for_each_contact(increment, [&](std::size_t, const auto& point, const auto& branch) {
    const Vec<D> force = point.force_on_j();
    for (std::size_t i = 0; i < D; ++i) {
      for (std::size_t j = 0; j < D; ++j) p[D * i + j] -= force[i] * branch[j] / volume;
    }
  });
  add_kinetic_stress(increment, p);
  return p;
}

// Assembles dP/dF from lanes: column k is dP for the change of F of lane k.
template <int D>
Tensor4<D> changes_of_stress(const Increment<D>& increment, const Sensitivity<D>& sensitivity,
                             std::size_t lanes) {
  Tensor4<D> tangent{};
  const double volume = increment.problem().space->reference_volume;
  const Tensor<D> pull_back = inverse<D>(increment.motion().deformation());
  const bool bound = increment.problem().space->bound_to_axes();
  const DeformationChange<D>& of_F = sensitivity.deformation_change();
  for_each_contact(increment, [&](std::size_t c, const auto& point, const auto& branch) {
    const Vec<D> force = point.force_on_j();
    const ContactChange<D>& change = sensitivity.changes(c);
    for (std::size_t k = 0; k < lanes; ++k) {
      // dL = d(F^-1 l) = F^-1 (dl - dF L), with both parts of the change of the branch in dl. A
      // space bound to axes has fixed branches.
      Vec<D> fluctuation{};
      for (std::size_t i = 0; i < D; ++i) fluctuation[i] = change.branch[i].lane[k];
      if constexpr (D == 2) {
        fluctuation[k / D] -= branch[k % D];
      } else {
        for (std::size_t m = 0; m < squared<D>; ++m) {
          fluctuation[m / D] -= of_F[m].lane[k] * branch[m % D];
        }
      }
      const Vec<D> branch_change = bound ? Vec<D>{} : product<D>(pull_back, fluctuation);
      for (std::size_t i = 0; i < D; ++i) {
        for (std::size_t j = 0; j < D; ++j) {
          tangent[(D * i + j) * squared<D> + k] -=
              (change.force[i].lane[k] * branch[j] + force[i] * branch_change[j]) / volume;
        }
      }
    }
  });
  add_kinetic_changes(increment, sensitivity, lanes, tangent);
  return tangent;
}

template <>
Tensor4<2> condensed_tangent(const Increment<2>& increment, const Sensitivity<2>& sensitivity) {
  auto tangent = changes_of_stress<2>(increment, sensitivity, squared<2>);
  clear_found<2>(*increment.problem().space, tangent);
  return tangent;
}

// Splits dF F_n^-1 per component of F into a stretch, whose lanes give dP, and a rotation of P.
template <>
Tensor4<3> condensed_tangent(const Increment<3>& increment, const Sensitivity<3>& sensitivity) {
  constexpr std::size_t n = squared<3>;
  const auto by_stretch = changes_of_stress<3>(increment, sensitivity, stretch_of_lane.size());
  const Tensor<3> stress = piola_stress(increment);
  const Tensor<3> inverse_committed = inverse<3>(increment.motion().committed_deformation());
  Tensor4<3> tangent{};
  for (std::size_t component = 0; component < n; ++component) {
    Tensor<3> direction{};
    direction[component] = 1;
    const Tensor<3> x = product<3>(direction, inverse_committed);
    Tensor<3> spin{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) spin[3 * i + j] = 0.5 * (x[3 * i + j] - x[3 * j + i]);
    }
    const Tensor<3> rotated = product<3>(spin, stress);
    for (std::size_t row = 0; row < n; ++row) {
      double sum = rotated[row];
      for (std::size_t lane = 0; lane < stretch_of_lane.size(); ++lane) {
        const auto [a, b] = stretch_of_lane[lane];
        sum += 0.5 * (x[3 * a + b] + x[3 * b + a]) * by_stretch[row * n + lane];
      }
      tangent[row * n + component] = sum;
    }
  }
  return tangent;
}

template <int D>
Tensor4<D> elastic_tangent(const Increment<D>& increment) {
  Tensor4<D> tangent{};
  const double volume = increment.problem().space->reference_volume;
  const auto& list = increment.contacts();
  const auto& law = *increment.problem().law;
  for_each_contact(increment, [&](std::size_t c, const auto& point, const auto& branch) {
    // Both stiffnesses of a Hertz-Mindlin contact are proportional to the root of the overlap,
    // @formula hertz.
    const double scale = law.hertzian() ? std::sqrt(list.reach[c] - point.distance) : 1;
    const double kn = scale * list.normal_stiffness[c];
    const double kt = scale * list.tangential_stiffness[c];
    const auto& n = point.normal;
    const auto across = point.tangents();
    for (std::size_t i = 0; i < D; ++i) {
      for (std::size_t j = 0; j < D; ++j) {
        for (std::size_t k = 0; k < D; ++k) {
          for (std::size_t l = 0; l < D; ++l) {
            double stiffness = kn * n[i] * n[k];
            for (const auto& t : across) stiffness += kt * t[i] * t[k];
            tangent[((D * i + j) * D + k) * D + l] += stiffness * branch[j] * branch[l] / volume;
          }
        }
      }
    }
  });
  condense_found<D>(*increment.problem().space, tangent);
  return tangent;
}

template Tensor<2> piola_stress(const Increment<2>&);
template Tensor<3> piola_stress(const Increment<3>&);
template Tensor4<2> elastic_tangent(const Increment<2>&);
template Tensor4<3> elastic_tangent(const Increment<3>&);

}  // namespace grainlaw::core
