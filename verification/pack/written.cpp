#include "pack/written.hpp"

#include "app/csv.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace verification {
namespace {

// Images of one contact, apart by lattice vectors, share its weight.
void weigh_copies(WrittenPacking& packing) {
  constexpr double places = 1e6;  // per cell side: resolution of equal midpoints
  const Eigen::Matrix2d to_cell = packing.cell.inverse();
  std::map<std::tuple<long, long, long, long>, std::vector<std::size_t>> groups;
  for (std::size_t c = 0; c < packing.contacts.size(); ++c) {
    const WrittenContact& contact = packing.contacts[c];
    const Eigen::Vector2d branch = to_cell * packing.branch(contact);
    const Eigen::Vector2d middle = to_cell * packing.centre[contact.i] + 0.5 * branch;
    const auto place = [&](double s) { return std::lround((s - std::floor(s + 1e-7)) * places); };
    const long along = std::lround(branch.x() * places);
    const long up = std::lround(branch.y() * places);
    const long sign = along < 0 || (along == 0 && up < 0) ? -1 : 1;
    groups[{place(middle.x()), place(middle.y()), sign * along, sign * up}].push_back(c);
  }
  for (const auto& [key, members] : groups)
    for (const std::size_t c : members)
      packing.contacts[c].weight = 1 / static_cast<double>(members.size());
}

}  // namespace

WrittenPacking read_written(const std::string& prefix) {
  const CsvTable table = read_csv(prefix + "_particles.csv");
  const CsvTable cell = read_csv(prefix + "_cell.csv");
  const CsvTable contacts = read_csv(prefix + "_contacts.csv");
  WrittenPacking packing;
  packing.cell << cell["H00"][0], cell["H01"][0], cell["H10"][0], cell["H11"][0];
  packing.radius = table["r"];
  const bool framed =
      std::find(table.names.begin(), table.names.end(), "frame_order") != table.names.end();
  std::map<int, std::size_t> number;  // index of an id
  std::vector<Eigen::Vector2i> wrap;
  std::map<double, std::size_t> boundary;
  for (std::size_t p = 0; p < table.rows(); ++p) {
    Eigen::Vector2d centre(table["x"][p], table["y"][p]);
    Eigen::Vector2i cells = Eigen::Vector2i::Zero();
    if (!framed) cells = (packing.cell.inverse() * centre).array().floor().cast<int>();
    packing.centre.push_back(centre - packing.cell * cells.cast<double>());
    wrap.push_back(cells);
    number[static_cast<int>(table["id"][p])] = p;
    if (framed && table["frame_order"][p] >= 0) boundary[table["frame_order"][p]] = p;
  }
  for (const auto& [order, particle] : boundary) packing.boundary.push_back(particle);
  for (std::size_t c = 0; c < contacts.rows(); ++c) {
    WrittenContact contact;
    contact.i = number.at(static_cast<int>(contacts["i"][c]));
    contact.j = number.at(static_cast<int>(contacts["j"][c]));
    // The written shift refers to unwrapped positions.
    const Eigen::Vector2d shift(contacts["shift_x"][c], contacts["shift_y"][c]);
    contact.shift = shift.cast<int>() + wrap[contact.j] - wrap[contact.i];
    contact.normal_force = contacts["fn"][c];
    packing.contacts.push_back(contact);
  }
  if (framed) weigh_copies(packing);
  return packing;
}

}  // namespace verification
