// Contacts of a packing's file, line by line.
#pragma once

#include "frame/frame_rows.hpp"
#include "packing/packing.hpp"

#include <fmt/format.h>

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace grainlaw::core {

// Sort key of contacts.
using ContactKey = std::array<int, 5>;
inline ContactKey key_of(const InitialContact& c) {
  return {c.i, c.j, c.shift[0], c.shift[1], c.shift[2]};
}

// The particle whose id a column contains.
template <class Table>
int read_particle(const Table& table, std::size_t column, const ParticleIds& ids) {
  const auto found = ids.find(table.integer(column));
  if (found == ids.end()) table.complain(column, "the id of a particle");
  return found->second;
}

// Reads the bond of a contact from two optional columns.
template <class Table>
void read_bond(const Table& table, std::size_t bonded, std::size_t gap, InitialContact& contact) {
  if (table.has(bonded)) {
    if (const auto flag = table.integer(bonded); flag != 0 && flag != 1)
      table.complain(bonded, "0 or 1");
    contact.bonded = table.integer(bonded) == 1;
  }
  if (table.has(gap)) contact.bond_gap = table.real(gap);
}

// Contacts in canonical orientation, each once, whichever particle its line names first.
class ContactLines {
 public:
  // Adds the contact of the table's present line, whose first column is the id of i.
  template <class Table>
  void add(const Table& table, InitialContact contact) {
    constexpr std::array<int, 3> none{};
    const bool of_itself = contact.i == contact.j;
    if (of_itself && contact.shift == none)
      table.fail(fmt::format("a particle (id {}) in contact with itself", table.text(0)));
    if (contact.i > contact.j || (of_itself && contact.shift < none)) reverse(contact);
    const auto [other, fresh] =
        contacts_.emplace(key_of(contact), std::pair(table.line(), contact));
    if (!fresh) table.fail(fmt::format("the contact of line {} again", other->second.first));
  }

  // Moves the sorted contacts to the packing; returns the line of each.
  std::vector<unsigned> hand_to(Packing& packing) const;

 private:
  // Reverses branch and forces.
  static void reverse(InitialContact& contact);

  std::map<ContactKey, std::pair<unsigned, InitialContact>> contacts_;
};

}  // namespace grainlaw::core
