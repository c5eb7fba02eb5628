#include "homogenise/stress.hpp"

#include "contact/contact_point.hpp"
#include "math/pull_back.hpp"

#include <cmath>

namespace grainlaw {

namespace {

// Calls visit(contact, point, L) for every touching contact.
template <class Visit>
void for_each_contact(const Increment& increment, Visit&& visit) {
  const PullBack pull_back(increment.deformation);
  for (std::size_t c = 0; c < increment.contacts.size(); ++c) {
    const auto point = contact_point(increment.contacts, c, increment.coordinates,
                                     increment.particles(), *increment.problem->law);
    if (point.status == ContactStatus::open) continue;
    visit(c, point,
          increment.problem->space->bound_to_axes() ? increment.fixed_branch(c)
                                                    : pull_back(point.branch_x, point.branch_y));
  }
}

std::array<double, 2> force_on_j(const ContactPoint& point) {
  return {point.normal_force * point.normal_x - point.tangential_force * point.normal_y,
          point.normal_force * point.normal_y + point.tangential_force * point.normal_x};
}

// Prescribed stresses stay, and the F that is given for them counts for nothing.
void clear_found(const BoundarySpace& space, std::array<double, 16>& tangent) {
  for (std::size_t k = 0; k < 4; ++k) {
    if (!space.found[k]) continue;
    for (std::size_t m = 0; m < 4; ++m) tangent[4 * k + m] = tangent[4 * m + k] = 0;
  }
}

// The same of a tangent at fixed F: the found components follow so that those stresses stay.
void condense_found(const BoundarySpace& space, std::array<double, 16>& tangent) {
  for (std::size_t k = 0; k < 4; ++k) {
    if (!space.found[k]) continue;
    const double pivot = tangent[5 * k];
    if (pivot != 0) {
      for (std::size_t m = 0; m < 4; ++m) {
        if (m == k) continue;
        const double factor = tangent[4 * m + k] / pivot;
        for (std::size_t l = 0; l < 4; ++l) tangent[4 * m + l] -= factor * tangent[4 * k + l];
      }
    }
    for (std::size_t m = 0; m < 4; ++m) tangent[4 * k + m] = tangent[4 * m + k] = 0;
  }
}

}  // namespace

std::array<double, 4> piola_stress(const Increment& increment) {
  std::array<double, 4> p{};
  const double volume = increment.problem->space->reference_volume;
  for_each_contact(increment, [&](std::size_t, const ContactPoint& point, const auto& branch) {
    const auto force = force_on_j(point);
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) p[2 * i + j] -= force[i] * branch[j] / volume;
    }
  });
  return p;
}

std::array<double, 16> condensed_tangent(const Increment& increment,
                                         const Sensitivity& sensitivity) {
  std::array<double, 16> tangent{};
  const double volume = increment.problem->space->reference_volume;
  const PullBack pull_back(increment.deformation);
  const bool bound = increment.problem->space->bound_to_axes();
  for_each_contact(increment, [&](std::size_t c, const ContactPoint& point, const auto& branch) {
    const auto force = force_on_j(point);
    for (std::size_t k = 0; k < 4; ++k) {
      const auto change = sensitivity.change(increment, c, point, k);
      const std::array<double, 2> force_change{change.force_x, change.force_y};
      // d(F^-1 l) = F^-1 (dl - dF L); the change of the branch holds both parts.
      // A space bound to axes has fixed branches.
      std::array<double, 2> fluctuation{change.branch_x, change.branch_y};
      fluctuation[k / 2] -= branch[k % 2];
      const auto branch_change =
          bound ? std::array{0.0, 0.0} : pull_back(fluctuation[0], fluctuation[1]);
      for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t j = 0; j < 2; ++j) {
          tangent[(2 * i + j) * 4 + k] -=
              (force_change[i] * branch[j] + force[i] * branch_change[j]) / volume;
        }
      }
    }
  });
  clear_found(*increment.problem->space, tangent);
  return tangent;
}

std::array<double, 16> elastic_tangent(const Increment& increment) {
  std::array<double, 16> tangent{};
  const double volume = increment.problem->space->reference_volume;
  const auto& list = increment.contacts;
  const auto& law = *increment.problem->law;
  for_each_contact(increment, [&](std::size_t c, const ContactPoint& point, const auto& branch) {
    // Both stiffnesses of a Hertz-Mindlin contact go with the square root of the overlap.
    const double scale = law.hertzian() ? std::sqrt(list.reach[c] - point.distance) : 1;
    const double kn = scale * list.normal_stiffness[c];
    const double kt = scale * list.tangential_stiffness[c];
    const std::array<double, 2> n{point.normal_x, point.normal_y};
    const std::array<double, 2> t{-point.normal_y, point.normal_x};
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) {
        for (std::size_t k = 0; k < 2; ++k) {
          for (std::size_t l = 0; l < 2; ++l) {
            tangent[((2 * i + j) * 2 + k) * 2 + l] +=
                (kn * n[i] * n[k] + kt * t[i] * t[k]) * branch[j] * branch[l] / volume;
          }
        }
      }
    }
  });
  condense_found(*increment.problem->space, tangent);
  return tangent;
}

}  // namespace grainlaw
