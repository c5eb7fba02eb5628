// Contacts with their forces.
#include "app/library.hpp"
#include "import/foreign_packing.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <unordered_map>

namespace verification {
namespace {

using Vector = Eigen::Vector3d;

Vector vector_of(const Place& place) { return Vector::Map(place.data()); }
Place place_of(const Vector& vector) { return {vector.x(), vector.y(), vector.z()}; }

// Three columns that belong together.
std::array<std::string, 3> axes(const std::string& name) {
  return {name + "x", name + "y", name + "z"};
}

void find_vector(Columns& columns, const std::string& name, const std::vector<std::string>& before,
                 const std::vector<std::string>& after = {""}) {
  for (const char axis : {'x', 'y', 'z'}) {
    std::vector<std::string> others;
    for (const std::string& first : before)
      for (const std::string& last : after) others.push_back(first + axis + last);
    columns.find(name + axis, others);
  }
}

Place vector_at(const Columns& columns, std::size_t row, const std::string& name) {
  Place result{};
  const auto names = axes(name);
  for (std::size_t k = 0; k < 3; ++k)
    if (columns.has(names[k])) result[k] = columns.real(row, names[k]);
  return result;
}

Columns force_columns(const SourceTable& table, const ForeignFiles& files) {
  Columns columns(table, read_choice("--contact-columns", files.contact_columns));
  columns.find("i", {"i", "id1", "id_1", "patom1", "particle1", "i.id1"});
  columns.find("j", {"j", "id2", "id_2", "patom2", "particle2", "i.id2"});
  find_vector(columns, "shift_", {"shift_", "celldist_", "cell_", "shift"});
  columns.find("fn", {"fn", "normal_force", "f_n"});
  find_vector(columns, "ft", {"ft", "fs", "shear_", "shearforce_"}, {"_on_j", ""});
  find_vector(columns, "f", {"f", "force_"}, {"", "_on_j"});
  columns.find("moment", {"moment"});
  find_vector(columns, "moment_", {"moment_"});
  columns.find("kn", {"kn"});
  columns.find("kt", {"kt", "ks"});
  columns.require({"i", "j"});
  if (!columns.has("fn") && !columns.has("fx")) columns.require({"fn"});
  columns.close("--contact-columns");
  return columns;
}

// The image of j that is nearest to i.
std::array<int, 3> nearest_shift(const ForeignPacking& packing, std::size_t i, std::size_t j) {
  const Eigen::Matrix3d h = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>::Map(packing.cell.data());
  const Vector apart = h.inverse() * (vector_of(packing.centre[j]) - vector_of(packing.centre[i]));
  std::array<int, 3> shift{};
  for (int k = 0; k < packing.dimension; ++k)
    shift[static_cast<std::size_t>(k)] = -static_cast<int>(std::lround(apart(k)));
  return shift;
}

using Key = std::tuple<std::size_t, std::size_t, std::array<int, 3>>;
Key key_of(const ForeignContact& c) {
  const std::array<int, 3> turned{-c.shift[0], -c.shift[1], -c.shift[2]};
  return c.i < c.j || (c.i == c.j && c.shift >= turned) ? Key{c.i, c.j, c.shift}
                                                        : Key{c.j, c.i, turned};
}

}  // namespace

void read_forces(const ForeignFiles& files, ForeignPacking& packing) {
  const SourceTable table = read_source(files.contacts, files.separator);
  const Columns columns = force_columns(table, files);
  std::unordered_map<long, std::size_t> number;
  for (std::size_t p = 0; p < packing.id.size(); ++p) number[packing.id[p]] = p;
  const auto particle = [&](std::size_t row, const char* name) {
    const long id = columns.integer(row, name);
    const auto found = number.find(id);
    if (found == number.end())
      table.fail(table.lines[row],
                 fmt::format("column {}: found {}, expected the id of a particle of {}", name, id,
                             files.particles));
    return found->second;
  };
  const bool whole =
      !columns.has("fn");  // one force, whose part along the branch is the normal one
  std::vector<Vector> force;
  double along = 0;
  int twice = 0, open = 0;
  std::set<Key> seen;
  packing.has_contacts = true;
  packing.has_moments = columns.has("moment") || columns.has("moment_x");
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    ForeignContact contact{.i = particle(row, "i"), .j = particle(row, "j")};
    contact.shift = nearest_shift(packing, contact.i, contact.j);
    if (columns.has("shift_x"))
      for (std::size_t k = 0; k < 3; ++k)
        if (const std::string name = axes("shift_")[k]; columns.has(name))
          contact.shift[k] = static_cast<int>(std::clamp(columns.integer(row, name), -511L, 511L));
    if (packing.dimension == 2) contact.shift[2] = 0;
    const double length = vector_of(packing.branch(contact)).norm();
    const double radii = packing.radius[contact.i] + packing.radius[contact.j];
    if (!(length > 0) || length > 2 * radii)
      table.fail(
          table.lines[row],
          fmt::format("found a contact of {} and {} whose centres are {:.6g} m apart, expected "
                      "about the sum of their radii, {:.6g} m",
                      packing.id[contact.i], packing.id[contact.j], length, radii));
    if (!seen.insert(key_of(contact)).second) {
      ++twice;
      continue;
    }
    if (whole) {
      force.push_back(vector_of(vector_at(columns, row, "f")));
      along += force.back().dot(vector_of(packing.branch(contact))) / length;
    } else {
      contact.normal = columns.real(row, "fn");
      contact.tangential = vector_at(columns, row, "ft");
    }
    const bool loaded = whole ? force.back().norm() > 0 : contact.normal != 0;
    if (!loaded && length >= radii) {  // a pair of a neighbour list
      ++open;
      if (whole) force.pop_back();
      continue;
    }
    if (columns.has("kn")) contact.stiffness = columns.positive(row, "kn");
    if (columns.has("kt")) contact.tangential_stiffness = columns.real(row, "kt");
    contact.moment = vector_at(columns, row, "moment_");
    if (columns.has("moment")) contact.moment[2] = columns.real(row, "moment");
    packing.contacts.push_back(contact);
  }
  for (std::size_t c = 0; c < force.size(); ++c) {
    ForeignContact& contact = packing.contacts[c];
    const Vector on_j = along < 0 ? Vector(-force[c]) : force[c];
    const Vector normal = vector_of(packing.branch(contact)).normalized();
    contact.normal = on_j.dot(normal);
    contact.tangential = place_of(on_j - contact.normal * normal);
  }
  if (along < 0)
    packing.notes.emplace_back("forces in the file act on the first particle of a contact");
  if (twice > 0)
    packing.notes.push_back(fmt::format("{} contacts stand twice in {}", twice, table.path));
  if (open > 0)
    packing.notes.push_back(
        fmt::format("{} pairs without force left out, which do not touch", open));
  packing.read.push_back(fmt::format("{} contacts from {}, {}: {}", packing.contacts.size(),
                                     table.path, table.kind, columns.text()));
}

namespace {

// What a contact says of the stiffness: normal = kn of unit 1, or over an overlap.
struct Pair {
  double normal = 0, overlap = 0, radius = 0;  // kn, 1 or fn, overlap [m]; 2 Ri Rj / (Ri + Rj) [m]
};

std::vector<Pair> pairs_of(const ForeignPacking& packing) {
  std::vector<Pair> pairs;
  for (const ForeignContact& c : packing.contacts) {
    const double ri = packing.radius[c.i], rj = packing.radius[c.j];
    const bool told = c.stiffness > 0;
    const Pair pair{told ? c.stiffness : c.normal, told ? 1 : packing.overlap(c),
                    2 * ri * rj / (ri + rj)};
    if (pair.normal > 0 && pair.overlap > 0) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace

FoundStiffness found_stiffness(const ForeignPacking& packing) {
  // Of all contacts together, so that small overlaps of rounded centres weigh little.
  const std::vector<Pair> pairs = pairs_of(packing);
  double force = 0, overlap = 0, scaled = 0, kn = 0, kt = 0;
  for (const Pair& pair : pairs) {
    force += pair.normal;
    overlap += pair.overlap;
    scaled += pair.overlap * pair.radius;
  }
  for (const ForeignContact& c : packing.contacts) {
    kn += c.stiffness;
    kt += c.tangential_stiffness;
  }
  FoundStiffness found;
  if (pairs.empty()) return found;
  double off_young = 0, off_kn = 0;
  for (const Pair& pair : pairs) {
    off_young += std::abs(pair.normal / force - pair.overlap * pair.radius / scaled);
    off_kn += std::abs(pair.normal / force - pair.overlap / overlap);
  }
  constexpr double alike = 0.02;  // of the forces: what centres of six digits leave
  if (off_young < alike && off_young <= off_kn)
    found.young = force / scaled;
  else if (off_kn < alike)
    found.kn = force / overlap;
  if (kn > 0 && kt > 0) found.ratio = kt / kn;
  return found;
}

}  // namespace verification
