// Contacts with their forces.
#include "app/library.hpp"
#include "import/balance.hpp"
#include "import/foreign_packing.hpp"
#include "import/images.hpp"

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
using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Vector vector_of(const Position& position) { return Vector::Map(position.data()); }
Position position_of(const Vector& vector) { return {vector.x(), vector.y(), vector.z()}; }

// Three columns that belong together.
std::array<std::string, 3> axes(const std::string& name) {
  return {name + "x", name + "y", name + "z"};
}

void find_vector(Columns& columns, const std::string& name, Quantity quantity,
                 const std::vector<std::string>& before,
                 const std::vector<std::string>& after = {""}, const std::string& numbered = "") {
  for (const char axis : {'x', 'y', 'z'}) {
    std::vector<std::string> others;
    for (const std::string& first : before)
      for (const std::string& last : after) others.push_back(first + axis + last);
    if (!numbered.empty()) others.push_back(numbered + static_cast<char>('1' + axis - 'x'));
    columns.find(name + axis, others, quantity);
  }
}

Position vector_at(const Columns& columns, std::size_t row, const std::string& name) {
  Position result{};
  const auto names = axes(name);
  for (std::size_t k = 0; k < 3; ++k)
    if (columns.has(names[k])) result[k] = columns.real(row, names[k]);
  return result;
}

Columns force_columns(const SourceTable& table, const ForeignFiles& files) {
  Columns columns(table, read_choice("--contact-columns", files.contact_columns));
  columns.find("i", {"i", "id1", "id_1", "patom1", "particle1", "i.id1"});
  columns.find("j", {"j", "id2", "id_2", "patom2", "particle2", "i.id2"});
  find_vector(columns, "shift_", Quantity::number, {"shift_", "celldist_", "cell_", "shift"});
  find_vector(columns, "d", Quantity::length, {"d"});
  columns.find("fn", {"fn", "normal_force", "f_n", table.lammps ? "force" : "fn"}, Quantity::force);
  find_vector(columns, "ft", Quantity::force, {"ft", "fs", "shear_", "shearforce_"}, {"_on_j", ""},
              table.lammps ? "p" : "");
  find_vector(columns, "f", Quantity::force, {"f", "force_"}, {"", "_on_j"});
  columns.find("moment", {"moment"}, Quantity::moment);
  find_vector(columns, "moment_", Quantity::moment, {"moment_"});
  columns.find("kn", {"kn"}, Quantity::stiffness);
  columns.find("kt", {"kt", "ks"}, Quantity::stiffness);
  columns.find("bonded", {"bonded"});
  columns.find("bond_gap", {"bond_gap"}, Quantity::length);
  columns.require({"i", "j"});
  if (!columns.has("fn") && !columns.has("fx")) columns.require({"fn"});
  columns.close("--contact-columns");
  return columns;
}

// From the axes of this file to those of the particles: LAMMPS has pairs of a general triclinic box in
// axes of its own.
Matrix rotation_between(const SourceTable& table, const SourceTable& particles) {
  constexpr double alike = 1e-4;  // of what is printed with six digits
  if (table.step && particles.step && *table.step != *particles.step)
    table.fail(fmt::format("found contacts of step {}, expected those of step {} as in {}",
                           *table.step, *particles.step, particles.path));
  if (!table.cell || !particles.cell) return Matrix::Identity();
  const Matrix here = table.unit(Quantity::length) * Matrix::Map(table.cell->data());
  const Matrix there = particles.unit(Quantity::length) * Matrix::Map(particles.cell->data());
  if ((here - there).norm() < alike * there.norm()) return Matrix::Identity();
  const Matrix rotation = there * here.inverse();
  if (!((rotation.transpose() * rotation - Matrix::Identity()).norm() < alike))
    table.fail(fmt::format("found another box than that of {}, expected the same", particles.path));
  return rotation;
}

using Key = std::tuple<std::size_t, std::size_t, Shift>;
Key key_of(const ForeignContact& c) {
  const Shift opposite{-c.shift[0], -c.shift[1], -c.shift[2]};
  return c.i < c.j || (c.i == c.j && c.shift >= opposite) ? Key{c.i, c.j, c.shift}
                                                          : Key{c.j, c.i, opposite};
}

class ForceReader {
 public:
  ForceReader(const SourceTable& table, const SourceTable& particles, const ForeignFiles& files,
              ForeignPacking& packing)
      : table_(table),
        particles_(particles),
        packing_(packing),
        columns_(force_columns(table, files)),
        rotation_(rotation_between(table, particles)) {
    for (std::size_t p = 0; p < packing.id.size(); ++p) number_[packing.id[p]] = p;
    packing.has_contacts = true;
    packing.has_moments = columns_.has("moment") || columns_.has("moment_x");
    packing.names_bonds = columns_.has("bonded");
  }

  void read() {
    std::set<Key> seen;
    int twice = 0, open = 0;
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      ForeignContact contact{.i = particle(row, "i"), .j = particle(row, "j")};
      contact.shift = shift(row, contact.i, contact.j);
      const double length = checked_length(row, contact);
      if (!seen.insert(key_of(contact)).second) {
        ++twice;
        continue;
      }
      const Vector force = read_force(row, contact);
      const bool loaded = force.norm() > 0 || contact.normal != 0;
      if (!loaded && !contact.bonded &&
          length >= packing_.radius[contact.i] + packing_.radius[contact.j]) {
        ++open;  // a pair of a neighbour list
        continue;
      }
      packing_.contacts.push_back(contact);
      force_.push_back(force);
    }
    if (!columns_.has("fn")) part_forces();
    settle_signs(table_, columns_.has("ftx") || columns_.has("fty"), packing_);
    note(twice, "contacts stand twice in " + table_.path);
    note(open, "pairs without force left out, which do not touch");
    packing_.read.insert(packing_.read.end() - 1,
                         fmt::format("{} contacts from {}, {}: {}", packing_.contacts.size(),
                                     table_.path, table_.kind, columns_.text()));
  }

 private:
  void note(int count, const std::string& text) {
    if (count > 0) packing_.notes.push_back(fmt::format("{} {}", count, text));
  }

  std::size_t particle(std::size_t row, const char* name) const {
    const long id = columns_.integer(row, name);
    const auto found = number_.find(id);
    if (found == number_.end())
      table_.fail(table_.lines[row],
                  fmt::format("column {}: found {}, expected the id of a particle of {}", name, id,
                              particles_.path));
    return found->second;
  }

  Shift shift(std::size_t row, std::size_t i, std::size_t j) const {
    Shift told{};
    if (columns_.has("shift_x")) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(packing_.dimension); ++k)
        if (const std::string name = axes("shift_")[k]; columns_.has(name))
          told[k] = static_cast<int>(std::clamp(columns_.integer(row, name), -511L, 511L));
      return told;
    }
    const std::vector<Shift> images = images_in_touch(packing_, i, j);
    if (images.size() == 1) return images.front();
    if (columns_.has("dx"))
      if (const auto one =
              image_apart(packing_, i, j, images,
                          position_of(rotation_ * vector_of(vector_at(columns_, row, "d")))))
        return *one;
    table_.fail(table_.lines[row],
                fmt::format("found a contact of {} and {}, which touch through {} images of the "
                            "cell, expected shift_x, shift_y, (shift_z,) or their distance dx, dy, "
                            "dz, which tell them apart",
                            packing_.id[i], packing_.id[j], images.size()));
  }

  double checked_length(std::size_t row, const ForeignContact& contact) const {
    const double length = vector_of(packing_.branch(contact)).norm();
    const double radii = packing_.radius[contact.i] + packing_.radius[contact.j];
    if (!(length > 0) || length > 2 * radii)
      table_.fail(
          table_.lines[row],
          fmt::format("found a contact of {} and {} whose centres are {:.6g} m apart, expected "
                      "about the sum of their radii, {:.6g} m",
                      packing_.id[contact.i], packing_.id[contact.j], length, radii));
    return length;
  }

  // Returns what fx, fy, fz are, if not the normal part by its size.
  Vector read_force(std::size_t row, ForeignContact& contact) const {
    const auto vector = [&](const char* name) {
      return Vector(rotation_ * vector_of(vector_at(columns_, row, name)));
    };
    if (columns_.has("kn")) contact.stiffness = columns_.positive(row, "kn");
    if (columns_.has("kt")) contact.tangential_stiffness = columns_.real(row, "kt");
    contact.moment = position_of(vector("moment_"));
    if (columns_.has("moment")) contact.moment[2] = columns_.real(row, "moment");
    if (columns_.has("bonded")) contact.bonded = columns_.integer(row, "bonded") != 0;
    if (columns_.has("bond_gap")) contact.bond_gap = columns_.real(row, "bond_gap");
    contact.tangential = position_of(vector("ft"));
    if (!columns_.has("fn")) return vector("f");
    contact.normal = columns_.real(row, "fn");
    return Vector::Zero();
  }

  // Forces that mostly press tell on which particle they act. Their part along the branch is the
  // normal one; the rest is the tangential one, unless that has columns of its own.
  void part_forces() {
    const auto normal = [&](const ForeignContact& c) {
      return vector_of(packing_.branch(c)).normalized();
    };
    double along = 0;
    for (std::size_t c = 0; c < force_.size(); ++c)
      along += force_[c].dot(normal(packing_.contacts[c]));
    const double sign = along < 0 ? -1 : 1;
    const bool whole = !columns_.has("ftx") && !columns_.has("fty");
    for (std::size_t c = 0; c < force_.size(); ++c) {
      ForeignContact& contact = packing_.contacts[c];
      const Vector on_j = sign * force_[c], n = normal(contact);
      contact.normal = on_j.dot(n);
      if (whole) contact.tangential = position_of(on_j - contact.normal * n);
    }
    if (along < 0)
      packing_.notes.emplace_back("forces in the file act on the first particle of a contact");
  }

  const SourceTable& table_;
  const SourceTable& particles_;
  ForeignPacking& packing_;
  Columns columns_;
  Matrix rotation_;
  std::unordered_map<long, std::size_t> number_;
  std::vector<Vector> force_;  // of each contact, where it is told as one vector
};

}  // namespace

void read_forces(const SourceTable& particles, const ForeignFiles& files, ForeignPacking& packing) {
  SourceTable table = read_source(files.contacts, files.separator, files.units);
  if (table.lammps && table.units.name.empty()) table.units = particles.units;
  ForceReader(table, particles, files, packing).read();
}

}  // namespace verification
