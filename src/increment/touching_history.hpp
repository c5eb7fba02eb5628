// History of the touching contacts since its start.
#pragma once

#include "contact/contact_list.hpp"
#include "contact/history.hpp"
#include "increment/configuration.hpp"
#include "increment/motion.hpp"

#include <vector>

namespace grainlaw::core {

// Contacts in the order of the neighbour search.
template <int D>
class TouchingHistory {
 public:
  // Begins with the history of configuration `from`.
  void begin(const Configuration<D>& from);
  // Clears the history and reserves memory for the number of pairs.
  void clear(const std::vector<NeighbourPair<D>>& pairs, const ContactLaw& law);
  // Adds contact c of the list with its overlap `depth` [m] and the random scatter of forces
  // `chance` [N].
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
  std::vector<double> moments_, gaps_;  // see Configuration
  bool spans_gaps_ = false;
};

}  // namespace grainlaw::core
