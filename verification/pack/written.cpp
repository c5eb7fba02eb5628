#include "pack/written.hpp"

#include "app/packing_tables.hpp"

#include <cmath>
#include <map>
#include <tuple>

namespace verification {
namespace {

// Images of one contact, apart by lattice vectors, share its weight.
void weigh_copies(WrittenPacking& packing) {
  constexpr double resolution = 1e6;  // per cell side: resolution of equal midpoints
  const Eigen::Matrix2d to_cell = packing.cell.inverse();
  std::map<std::tuple<long, long, long, long>, std::vector<std::size_t>> groups;
  for (std::size_t c = 0; c < packing.contacts.size(); ++c) {
    const WrittenContact& contact = packing.contacts[c];
    const Eigen::Vector2d branch = to_cell * packing.branch(contact);
    const Eigen::Vector2d middle = to_cell * packing.centre[contact.i] + 0.5 * branch;
    const auto rounded = [&](double s) {
      return std::lround((s - std::floor(s + 1e-7)) * resolution);
    };
    const long along = std::lround(branch.x() * resolution);
    const long up = std::lround(branch.y() * resolution);
    const long sign = along < 0 || (along == 0 && up < 0) ? -1 : 1;
    groups[{rounded(middle.x()), rounded(middle.y()), sign * along, sign * up}].push_back(c);
  }
  for (const auto& [key, members] : groups)
    for (const std::size_t c : members)
      packing.contacts[c].weight = 1 / static_cast<double>(members.size());
}

}  // namespace

WrittenPacking read_written(const std::string& prefix) {
  const PackingTables tables = read_packing_tables(prefix);
  const CsvTable &particles = tables.particles, &contacts = tables.contacts;
  WrittenPacking packing;
  packing.cell = Eigen::Map<const Eigen::Matrix<double, 2, 2, Eigen::RowMajor>>(tables.h.data());
  packing.radius = particles["r"];
  packing.boundary = tables.boundary;
  std::vector<Eigen::Vector2i> wrap;
  for (std::size_t p = 0; p < particles.rows(); ++p) {
    Eigen::Vector2d centre(particles["x"][p], particles["y"][p]);
    Eigen::Vector2i cells = Eigen::Vector2i::Zero();
    if (!tables.framed()) cells = (packing.cell.inverse() * centre).array().floor().cast<int>();
    packing.centre.push_back(centre - packing.cell * cells.cast<double>());
    wrap.push_back(cells);
  }
  for (std::size_t c = 0; c < contacts.rows(); ++c) {
    WrittenContact contact;
    std::tie(contact.i, contact.j) = tables.pairs[c];
    // The written shift refers to unwrapped positions.
    const Eigen::Vector2d shift(contacts["shift_x"][c], contacts["shift_y"][c]);
    contact.shift = shift.cast<int>() + wrap[contact.j] - wrap[contact.i];
    contact.normal_force = contacts["fn"][c];
    packing.contacts.push_back(contact);
  }
  if (tables.framed()) weigh_copies(packing);
  return packing;
}

}  // namespace verification
