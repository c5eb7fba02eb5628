// What contacts that touch bring along from where the history starts.
#pragma once

#include "contact/contact_list.hpp"
#include "contact/history.hpp"
#include "increment/configuration.hpp"
#include "increment/motion.hpp"

#include <vector>

namespace grainlaw::core {

// Ordered as the pairs of the neighbour search are.
template <int D>
class TouchingHistory {
 public:
  // As `from` left it.
  void begin(const Configuration<D>& from);
  // Anew, of no more contacts than there are pairs, with room for as many as they have.
  void clear(const std::vector<NeighbourPair<D>>& pairs, const ContactLaw& law);
  // The next contact of the list with its depth of overlap [m], from forces that differ by chance so much [N].
  void add(const ContactList<D>& contacts, std::size_t c, const NeighbourPair<D>& pair,
           double depth, double chance, const ContactLaw& law);
  void break_bond(std::size_t h) { contacts_[h].bonded = false; }

  [[nodiscard]] const std::vector<ContactHistory<D>>& contacts() const { return contacts_; }
  [[nodiscard]] HistoryStart<D> from(const Motion<D>& motion) const {
    return {motion.start(), motion.start_cell(), contacts_, moments_, gaps_};
  }
  void export_to(Configuration<D>& to) const;

 private:
  std::vector<ContactHistory<D>> contacts_;
  std::vector<double> moments_, gaps_;  // as in Configuration
  bool spans_gaps_ = false;
};

}  // namespace grainlaw::core
