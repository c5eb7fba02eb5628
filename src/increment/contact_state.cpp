#include "increment/contact_state.hpp"

#include "base/constants.hpp"
#include "contact/contact_point.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

template <int D>
double overlap_of(const ForceBalance<D>& balance, std::size_t c) {
  return balance.contacts().rest_of(c) - std::sqrt(square<D>(branch_of(balance, c)));
}

template <int D>
bool bears_load(const Increment<D>& increment, std::size_t c) {
  const auto& contacts = increment.contacts();
  if (contacts.bonded(c)) return true;
  if (increment.released()) return false;
  return normal_force(contacts, c, overlap_of(increment, c), *increment.problem().law) >
         tuned::more_than_chance * increment.scale().chance();
}

template <int D>
bool loaded(const Increment<D>& increment) {
  if (increment.problem().inertia) return true;
  for (std::size_t c = 0; c < increment.contacts().size(); ++c) {
    if (bears_load(increment, c)) return true;
  }
  return false;
}

template <int D>
void find_supported(const Increment<D>& increment, std::vector<unsigned char>& supported) {
  const auto& space = *increment.problem().space;
  const auto& contacts = increment.contacts();
  supported.assign(increment.problem().nodes(), 0);
  if (increment.motion().drag().acts())
    return std::fill(supported.begin(), supported.end(), fixed_translation<D>);
  for (std::size_t q = 0; q < space.fixed.size(); ++q)
    supported[q] = space.fixed[q] & fixed_translation<D>;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (!bears_load(increment, c)) continue;
    for (const auto p : {contacts.i[c], contacts.j[c]}) {
      supported[static_cast<std::size_t>(space.node[static_cast<std::size_t>(p)])] =
          fixed_translation<D>;
    }
  }
}

template <int D>
bool collapsed(Increment<D>& increment) {
  const auto& problem = increment.problem();
  if (!problem.space->averages()) return false;
  return increment.scale().mean_force() < problem.force_floor || increment.released_particle() >= 0;
}

template <int D>
bool lost(Increment<D>& increment) {
  return !increment.held() || collapsed(increment);
}

#define GRAINLAW_FOR(D)                                                           \
  template double overlap_of(const ForceBalance<D>&, std::size_t);                \
  template bool bears_load(const Increment<D>&, std::size_t);                     \
  template bool loaded(const Increment<D>&);                                      \
  template void find_supported(const Increment<D>&, std::vector<unsigned char>&); \
  template bool collapsed(Increment<D>&);                                         \
  template bool lost(Increment<D>&);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core
