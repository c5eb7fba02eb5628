#include "app/snapshot.hpp"

#include "app/packing_tables.hpp"
#include "app/scratch.hpp"

#include <cmath>

namespace verification {
namespace {

template <class Record, class Function>
std::vector<Record> list(const grainlaw_state* state, Function* function) {
  std::size_t count = 0;
  check(function(state, nullptr, sizeof(Record), &count), "counting particles or contacts");
  std::vector<Record> records(count);
  check(function(state, records.data(), sizeof(Record), &count), "listing particles or contacts");
  return records;
}

// Cell and order of a frame, which the arrays of the library do not have.
void read_cell(const grainlaw_state* state, Snapshot& snapshot) {
  const ScratchDirectory scratch;
  const std::string prefix = (scratch / "state").string();
  check(grainlaw_state_write_packing(state, prefix.c_str()), "writing " + prefix);
  PackingTables written = read_packing_tables(prefix);
  snapshot.cell = std::move(written.h);
  snapshot.boundary = std::move(written.boundary);
}

}  // namespace

Snapshot take_snapshot(const grainlaw_state* state) {
  Snapshot snapshot;
  read_cell(state, snapshot);
  const bool spheres = snapshot.cell.size() == 9;
  for (const auto& particle : list<grainlaw_particle>(state, grainlaw_state_particles)) {
    const auto& [x, y, z] = particle.position;
    const auto& angles = particle.rotation;
    snapshot.x.push_back(x);
    snapshot.y.push_back(y);
    if (spheres) snapshot.z.push_back(z);
    snapshot.radius.push_back(particle.radius);
    snapshot.rotation.push_back(spheres ? std::hypot(angles[0], angles[1], angles[2]) : angles[2]);
  }
  const auto& h = snapshot.cell;
  for (const auto& touching : list<grainlaw_contact>(state, grainlaw_state_contacts)) {
    SnapshotContact contact;
    contact.i = touching.i;
    contact.j = touching.j;
    const auto i = static_cast<std::size_t>(contact.i);
    const auto j = static_cast<std::size_t>(contact.j);
    const auto& [a, b, e] = touching.shift;
    if (spheres) {
      contact.branch = {snapshot.x[j] - snapshot.x[i] + h[0] * a + h[1] * b + h[2] * e,
                        snapshot.y[j] - snapshot.y[i] + h[3] * a + h[4] * b + h[5] * e,
                        snapshot.z[j] - snapshot.z[i] + h[6] * a + h[7] * b + h[8] * e};
    } else {
      contact.branch = {snapshot.x[j] - snapshot.x[i] + h[0] * a + h[1] * b,
                        snapshot.y[j] - snapshot.y[i] + h[2] * a + h[3] * b, 0};
    }
    contact.normal_force = touching.normal_force;
    contact.bonded = touching.bonded != 0;
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
