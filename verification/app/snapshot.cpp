#include "app/snapshot.hpp"

#include "app/csv.hpp"
#include "app/scratch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

namespace verification {
namespace {

// Point array of this name in a .vtp file of ASCII arrays, one point per line; vectors give their
// lengths.
std::vector<double> read_point_array(const std::string& path, const std::string& name) {
  std::ifstream file(path);
  std::string line;
  const std::string wanted = "Name=\"" + name + "\"";
  while (std::getline(file, line) && line.find(wanted) == std::string::npos) {
  }
  std::vector<double> values;
  while (std::getline(file, line) && line.find('<') == std::string::npos) {
    std::istringstream words(line);
    std::array<double, 3> v{};
    int count = 0;
    while (count < 3 && words >> v[static_cast<std::size_t>(count)]) ++count;
    values.push_back(count > 1 ? std::hypot(v[0], v[1], v[2]) : v[0]);
  }
  return values;
}

bool has_column(const CsvTable& table, const char* name) {
  return std::find(table.names.begin(), table.names.end(), name) != table.names.end();
}

std::vector<int> boundary_in_order(const CsvTable& particles) {
  if (!has_column(particles, "frame_order")) return {};
  std::map<int, int> by_place;
  const std::vector<double>& order = particles["frame_order"];
  for (std::size_t p = 0; p < order.size(); ++p)
    if (order[p] >= 0) by_place[static_cast<int>(order[p])] = static_cast<int>(p);
  std::vector<int> boundary;
  for (const auto& [place, particle] : by_place) boundary.push_back(particle);
  return boundary;
}

}  // namespace

Snapshot take_snapshot(const grainlaw_state* state) {
  const ScratchDirectory scratch;
  const std::string prefix = (scratch / "state").string();
  check(grainlaw_state_write_packing(state, prefix.c_str()), "writing " + prefix);
  check(grainlaw_state_write_vtk(state, (prefix + ".vtp").c_str()), "writing " + prefix + ".vtp");
  const CsvTable particles = read_csv(prefix + "_particles.csv");
  const CsvTable contacts = read_csv(prefix + "_contacts.csv");
  const CsvTable cell = read_csv(prefix + "_cell.csv");

  Snapshot snapshot;
  snapshot.x = particles["x"];
  snapshot.y = particles["y"];
  snapshot.radius = particles["r"];
  snapshot.boundary = boundary_in_order(particles);
  if (has_column(particles, "z")) snapshot.z = particles["z"];
  const int dimension = snapshot.spheres() ? 3 : 2;
  for (int i = 0; i < dimension; ++i)
    for (int j = 0; j < dimension; ++j)
      snapshot.cell.push_back(cell[fmt::format("H{}{}", i, j)][0]);
  snapshot.rotation = read_point_array(prefix + ".vtp", "rotation");
  if (snapshot.rotation.size() < snapshot.size())
    throw ComputationError(fmt::format("{}.vtp: {} rotations of {} particles", prefix,
                                       snapshot.rotation.size(), snapshot.size()));
  snapshot.rotation.resize(snapshot.size());

  std::map<int, int> number;
  for (std::size_t p = 0; p < snapshot.size(); ++p)
    number[static_cast<int>(particles["id"][p])] = static_cast<int>(p);
  const bool bonds = has_column(contacts, "bonded");
  const auto& h = snapshot.cell;
  for (std::size_t c = 0; c < contacts.rows(); ++c) {
    SnapshotContact contact;
    contact.i = number.at(static_cast<int>(contacts["i"][c]));
    contact.j = number.at(static_cast<int>(contacts["j"][c]));
    const auto i = static_cast<std::size_t>(contact.i);
    const auto j = static_cast<std::size_t>(contact.j);
    const double a = contacts["shift_x"][c], b = contacts["shift_y"][c];
    if (snapshot.spheres()) {
      const double e = contacts["shift_z"][c];
      contact.branch = {snapshot.x[j] - snapshot.x[i] + h[0] * a + h[1] * b + h[2] * e,
                        snapshot.y[j] - snapshot.y[i] + h[3] * a + h[4] * b + h[5] * e,
                        snapshot.z[j] - snapshot.z[i] + h[6] * a + h[7] * b + h[8] * e};
    } else {
      contact.branch = {snapshot.x[j] - snapshot.x[i] + h[0] * a + h[1] * b,
                        snapshot.y[j] - snapshot.y[i] + h[2] * a + h[3] * b, 0};
    }
    contact.normal_force = contacts["fn"][c];
    contact.bonded = bonds && contacts["bonded"][c] != 0;
    snapshot.contacts.push_back(contact);
  }
  return snapshot;
}

double normalised_overlap(const Snapshot& snapshot) {
  double sum = 0;
  int touching = 0;
  for (const SnapshotContact& contact : snapshot.contacts) {
    const double radii = snapshot.radius[static_cast<std::size_t>(contact.i)] +
                         snapshot.radius[static_cast<std::size_t>(contact.j)];
    const double overlap = radii - contact.length();
    if (overlap <= 0) continue;
    sum += overlap / (0.5 * radii);
    ++touching;
  }
  return touching > 0 ? sum / touching : 0;
}

double mean_rotation_magnitude(const Snapshot& snapshot) {
  double sum = 0;
  for (const double rotation : snapshot.rotation) sum += std::abs(rotation);
  return snapshot.rotation.empty() ? 0 : sum / static_cast<double>(snapshot.rotation.size());
}

}  // namespace verification
