#include "homogenise/stress.hpp"

#include "contact/contact_point.hpp"

#include <cmath>

namespace grainlaw {

namespace {

// Calls visit(contact, point, L) for every touching contact.
template <int D, class Visit>
void for_each_contact(const Increment<D>& increment, Visit&& visit) {
  const Tensor<D> pull_back = inverse<D>(increment.deformation);
  for (std::size_t c = 0; c < increment.contacts.size(); ++c) {
    const auto point = contact_point(increment.contacts, c, increment.coordinates,
                                     increment.particles(), *increment.problem->law);
    if (point.status == ContactStatus::open) continue;
    visit(c, point,
          increment.problem->space->bound_to_axes() ? increment.fixed_branch(c)
                                                    : product<D>(pull_back, point.branch));
  }
}

// Prescribed stresses stay, and the F that is given for them counts for nothing.
template <int D>
void clear_found(const BoundarySpace<D>& space, Tensor4<D>& tangent) {
  constexpr std::size_t n = squared<D>;
  for (std::size_t k = 0; k < n; ++k) {
    if (!space.found[k]) continue;
    for (std::size_t m = 0; m < n; ++m) tangent[n * k + m] = tangent[n * m + k] = 0;
  }
}

// The same of a tangent at fixed F: the found components follow so that those stresses stay.
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
  const double volume = increment.problem->space->reference_volume;
  for_each_contact(increment, [&](std::size_t, const auto& point, const auto& branch) {
    const Vec<D> force = point.force_on_j();
    for (std::size_t i = 0; i < D; ++i) {
      for (std::size_t j = 0; j < D; ++j) p[D * i + j] -= force[i] * branch[j] / volume;
    }
  });
  return p;
}

template <int D>
Tensor4<D> condensed_tangent(const Increment<D>& increment, const Sensitivity<D>& sensitivity) {
  Tensor4<D> tangent{};
  const double volume = increment.problem->space->reference_volume;
  const Tensor<D> pull_back = inverse<D>(increment.deformation);
  const bool bound = increment.problem->space->bound_to_axes();
  for_each_contact(increment, [&](std::size_t c, const auto& point, const auto& branch) {
    const Vec<D> force = point.force_on_j();
    const ContactChange<D>& change = sensitivity.changes(c);
    for (std::size_t k = 0; k < squared<D>; ++k) {
      // d(F^-1 l) = F^-1 (dl - dF L); the change of the branch holds both parts.
      // A space bound to axes has fixed branches.
      Vec<D> fluctuation{};
      for (std::size_t i = 0; i < D; ++i) fluctuation[i] = change.branch[i].lane[k];
      fluctuation[k / D] -= branch[k % D];
      const Vec<D> branch_change = bound ? Vec<D>{} : product<D>(pull_back, fluctuation);
      for (std::size_t i = 0; i < D; ++i) {
        for (std::size_t j = 0; j < D; ++j) {
          tangent[(D * i + j) * squared<D> + k] -=
              (change.force[i].lane[k] * branch[j] + force[i] * branch_change[j]) / volume;
        }
      }
    }
  });
  clear_found<D>(*increment.problem->space, tangent);
  return tangent;
}

template <int D>
Tensor4<D> elastic_tangent(const Increment<D>& increment) {
  Tensor4<D> tangent{};
  const double volume = increment.problem->space->reference_volume;
  const auto& list = increment.contacts;
  const auto& law = *increment.problem->law;
  for_each_contact(increment, [&](std::size_t c, const auto& point, const auto& branch) {
    // Both stiffnesses of a Hertz-Mindlin contact go with the square root of the overlap.
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
  condense_found<D>(*increment.problem->space, tangent);
  return tangent;
}

template Tensor<2> piola_stress(const Increment<2>&);
template Tensor4<2> condensed_tangent(const Increment<2>&, const Sensitivity<2>&);
template Tensor4<2> elastic_tangent(const Increment<2>&);

}  // namespace grainlaw
