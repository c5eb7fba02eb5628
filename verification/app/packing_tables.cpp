#include "app/packing_tables.hpp"

#include <fmt/format.h>

namespace verification {

PackingTables read_packing_tables(const std::string& prefix) {
  PackingTables packing;
  packing.particles = read_csv(prefix + "_particles.csv");
  packing.contacts = read_csv(prefix + "_contacts.csv");
  packing.cell = read_csv(prefix + "_cell.csv");
  const std::vector<double>& id = packing.particles["id"];
  for (std::size_t p = 0; p < id.size(); ++p) packing.number[id[p]] = p;
  const auto& i = packing.contacts["i"];
  const auto& j = packing.contacts["j"];
  for (std::size_t c = 0; c < i.size(); ++c)
    packing.pairs.emplace_back(packing.number.at(i[c]), packing.number.at(j[c]));
  if (packing.framed()) {
    const std::vector<double>& order = packing.particles["frame_order"];
    std::map<double, std::size_t> by_order;
    for (std::size_t p = 0; p < order.size(); ++p)
      if (order[p] >= 0) by_order[order[p]] = p;
    for (const auto& [order, particle] : by_order) packing.boundary.push_back(particle);
  }
  const int dimension = packing.particles.has("z") ? 3 : 2;
  for (int row = 0; row < dimension; ++row)
    for (int column = 0; column < dimension; ++column)
      packing.h.push_back(packing.cell[fmt::format("H{}{}", row, column)].at(0));
  return packing;
}

}  // namespace verification
