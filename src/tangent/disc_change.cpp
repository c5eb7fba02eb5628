// Changes of the contacts of discs.
#include "tangent/contact_change.hpp"

#include "increment/contact_state.hpp"

namespace grainlaw::core {

namespace {

using Quad = ByDeformation<2>;
using simd::store;
using Lanes = simd::Lanes<4>;
constexpr std::size_t width = 4;
GRAINLAW_INLINE Lanes load(const double* from) { return simd::load<4>(from); }

// Data that all contacts share, and the arrays they write to.
struct ContactLoop {
  std::span<const TouchingContact<2>> touching;
  Tensor<2> inverse;           // F^-1
  const Quad* deformation;     // change of F
  const Quad* start_rotation;  // per listed contact; null before the first history
  const Quad* start_force;
  const double* tangential_stiffness;
  const Increment<2>* bound_to_axes;  // null: branches are pulled back
};

ContactLoop contact_loop(const Increment<2>& increment,
                         std::span<const TouchingContact<2>> touching,
                         const DeformationChange<2>& change, const HistoryChange<2>& history) {
  return {touching,
          inverse<2>(increment.motion().deformation()),
          change.data(),
          history.rotation,
          history.force,
          increment.contacts().tangential_stiffness.data(),
          increment.problem().space->bound_to_axes() ? &increment : nullptr};
}

// Branch that F deforms [m].
GRAINLAW_INLINE Vec<2> reference_branch(const ContactLoop& loop,
                                        const TouchingContact<2>& contact) {
  return loop.bound_to_axes == nullptr ? product<2>(loop.inverse, contact.point.branch)
                                       : fixed_branch_of(*loop.bound_to_axes, contact.index);
}

// Computes the change of one contact and returns that of the couple d ft. With `motion` null only
// affine motion and history count.
template <bool rotating>
GRAINLAW_INLINE Lanes change_of(const ContactLoop& loop, const TouchingContact<2>& contact,
                                const double* motion, Lanes& force_x, Lanes& force_y,
                                Lanes& branch_x, Lanes& branch_y, Lanes& tangential_force) {
  constexpr std::size_t b = rotating ? 3 : 2;
  const auto& point = contact.point;
  const auto reference = reference_branch(loop, contact);
  branch_x =
      load(loop.deformation[0].lane) * reference[0] + load(loop.deformation[1].lane) * reference[1];
  branch_y =
      load(loop.deformation[2].lane) * reference[0] + load(loop.deformation[3].lane) * reference[1];
  Lanes rotation{};
  if (motion != nullptr) {
    const double* zi = motion + contact.node_i * b * width;
    const double* zj = motion + contact.node_j * b * width;
    branch_x += load(zj) - load(zi);
    branch_y += load(zj + width) - load(zi + width);
    if constexpr (rotating) {
      rotation =
          contact.lever_i * load(zi + 2 * width) + (1 - contact.lever_i) * load(zj + 2 * width);
    }
  }
  const double nx = point.normal[0];
  const double ny = point.normal[1];
  const auto& s = contact.stiffness;
  const Lanes normal = nx * branch_x + ny * branch_y;
  const Lanes tangential = nx * branch_y - ny * branch_x;
  const Lanes along_n = s[0] * normal + s[1] * tangential + s[2] * rotation;
  Lanes along_t = s[3] * normal + s[4] * tangential + s[5] * rotation;
  Lanes couple = s[6] * normal + s[7] * tangential + s[8] * rotation;
  if (loop.start_rotation != nullptr && point.status != ContactStatus::sliding) {
    const Lanes by_history = load(loop.start_force[contact.index].lane) -
                             loop.tangential_stiffness[contact.index] * point.distance *
                                 load(loop.start_rotation[contact.index].lane);
    along_t += by_history;
    couple += point.distance * by_history;
  }
  force_x = nx * along_n - ny * along_t;
  force_y = ny * along_n + nx * along_t;
  tangential_force = (couple - point.tangential_force * normal) / point.distance;
  return couple;
}

template <bool rotating>
GRAINLAW_INLINE void sum_right_sides(const ContactLoop& loop, double* right) {
  constexpr std::size_t b = rotating ? 3 : 2;
  Lanes fx{}, fy{}, bx{}, by{}, ft{};
  for (const auto& contact : loop.touching) {
    const Lanes couple = change_of<rotating>(loop, contact, nullptr, fx, fy, bx, by, ft);
    double* ri = right + contact.node_i * b * width;
    double* rj = right + contact.node_j * b * width;
    store(ri, load(ri) - fx);
    store(ri + width, load(ri + width) - fy);
    store(rj, load(rj) + fx);
    store(rj + width, load(rj + width) + fy);
    if constexpr (rotating) {
      store(ri + 2 * width, load(ri + 2 * width) - contact.lever_i * couple);
      store(rj + 2 * width, load(rj + 2 * width) - (1 - contact.lever_i) * couple);
    }
  }
}

template <bool rotating>
GRAINLAW_INLINE void find_changes(const ContactLoop& loop, const double* motion,
                                  ContactChange<2>* changes) {
  for (const auto& contact : loop.touching) {
    Lanes fx{}, fy{}, bx{}, by{}, ft{};
    change_of<rotating>(loop, contact, motion, fx, fy, bx, by, ft);
    store(changes->force[0].lane, fx);
    store(changes->force[1].lane, fy);
    store(changes->branch[0].lane, bx);
    store(changes->branch[1].lane, by);
    store(changes->tangential_force[0].lane, ft);
    ++changes;
  }
}

GRAINLAW_CLONES void right_sides(const ContactLoop& loop, bool rotating, double* right) {
  rotating ? sum_right_sides<true>(loop, right) : sum_right_sides<false>(loop, right);
}
GRAINLAW_CLONES void all_changes(const ContactLoop& loop, bool rotating, const double* motion,
                                 ContactChange<2>* changes) {
  rotating ? find_changes<true>(loop, motion, changes) : find_changes<false>(loop, motion, changes);
}
// Computes the change of the moment on j. With `motion` null only affine motion and history count.
Lanes moment_change_of(const Increment<2>& increment, const ContactLoop& loop,
                       const TouchingContact<2>& contact, const ContactMoment<2>& moment,
                       const HistoryChange<2>& history, const double* motion) {
  const auto& point = contact.point;
  const auto reference = reference_branch(loop, contact);
  Lanes branch_x =
      load(loop.deformation[0].lane) * reference[0] + load(loop.deformation[1].lane) * reference[1];
  Lanes branch_y =
      load(loop.deformation[2].lane) * reference[0] + load(loop.deformation[3].lane) * reference[1];
  Lanes spin{};
  if (motion != nullptr) {
    const double* zi = motion + contact.node_i * 3 * width;
    const double* zj = motion + contact.node_j * 3 * width;
    branch_x += load(zj) - load(zi);
    branch_y += load(zj + width) - load(zi + width);
    spin = load(zj + 2 * width) - load(zi + 2 * width);
  }
  Lanes change = moment.by_normal * (point.normal[0] * branch_x + point.normal[1] * branch_y) +
                 moment.by_spin * spin;
  if (history.moment != nullptr && !moment.capped) {
    change += load(history.moment[contact.index].lane) +
              increment.contacts().bending_stiffness[contact.index] *
                  load(history.spin[contact.index].lane);
  }
  return change;
}

void add_moment_changes(const Increment<2>& increment, const ContactLoop& loop,
                        std::span<const ContactMoment<2>> moments, const HistoryChange<2>& history,
                        std::span<Quad> residual) {
  for (std::size_t m = 0; m < loop.touching.size(); ++m) {
    const auto& contact = loop.touching[m];
    const Lanes change = moment_change_of(increment, loop, contact, moments[m], history, nullptr);
    double* at_i = residual[3 * contact.node_i + 2].lane;
    double* at_j = residual[3 * contact.node_j + 2].lane;
    store(at_i, load(at_i) - change);
    store(at_j, load(at_j) + change);
  }
}

}  // namespace

template <>
void add_residual_changes<2>(const Increment<2>& increment, const Stiffness<2>& stiffness,
                             const DeformationChange<2>& change, const HistoryChange<2>& history,
                             std::span<Quad> residual) {
  const auto& law = *increment.problem().law;
  const auto loop = contact_loop(increment, stiffness.touching(), change, history);
  right_sides(loop, law.rotating(), residual.data()->lane);
  if (law.moments()) add_moment_changes(increment, loop, stiffness.moments(), history, residual);
}

template <>
void find_contact_changes<2>(const Increment<2>& increment,
                             std::span<const TouchingContact<2>> touching,
                             const DeformationChange<2>& change, const HistoryChange<2>& history,
                             std::span<const Quad> motion, std::span<ContactChange<2>> changes) {
  all_changes(contact_loop(increment, touching, change, history),
              increment.problem().law->rotating(), motion.data()->lane, changes.data());
}

template <>
void find_moment_changes<2>(const Increment<2>& increment, const Stiffness<2>& stiffness,
                            const DeformationChange<2>& change, const HistoryChange<2>& history,
                            std::span<const Quad> motion, std::span<Quad> changes) {
  const auto loop = contact_loop(increment, stiffness.touching(), change, history);
  const auto moments = stiffness.moments();
  for (std::size_t m = 0; m < loop.touching.size(); ++m) {
    const auto& contact = loop.touching[m];
    store(changes[m].lane,
          moment_change_of(increment, loop, contact, moments[m], history, motion.data()->lane));
  }
}

}  // namespace grainlaw::core
