#include "material/contact_lines.hpp"

namespace grainlaw::core {

void ContactLines::reverse(InitialContact& contact) {
  std::swap(contact.i, contact.j);
  for (int& component : contact.shift) component = -component;
  for (double& component : contact.tangential_force) component = -component;
  for (double& component : contact.moment) component = -component;
}

std::vector<unsigned> ContactLines::hand_to(Packing& packing) const {
  std::vector<unsigned> lines;
  for (const auto& [key, value] : contacts_) {
    packing.contacts.push_back(value.second);
    lines.push_back(value.first);
  }
  return lines;
}

}  // namespace grainlaw::core
