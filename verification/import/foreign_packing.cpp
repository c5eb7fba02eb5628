#include "import/foreign_packing.hpp"

#include "app/atomic_file.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace verification {
namespace {

using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

std::string particles_text(const ForeignPacking& packing) {
  const bool spheres = packing.dimension == 3;
  std::string text = spheres ? "id,x,y,z,r\n" : "id,x,y,r\n";
  for (std::size_t p = 0; p < packing.radius.size(); ++p) {
    const Position& x = packing.centre[p];
    fmt::format_to(std::back_inserter(text), "{},{},{},", packing.id[p], x[0], x[1]);
    if (spheres) fmt::format_to(std::back_inserter(text), "{},", x[2]);
    fmt::format_to(std::back_inserter(text), "{}\n", packing.radius[p]);
  }
  return text;
}

std::string contacts_text(const ForeignPacking& packing) {
  const bool spheres = packing.dimension == 3;
  const auto out = [](std::string& text) { return std::back_inserter(text); };
  std::string text = spheres ? "i,j,shift_x,shift_y,shift_z,fn,ftx_on_j,fty_on_j,ftz_on_j"
                             : "i,j,shift_x,shift_y,fn,ftx_on_j,fty_on_j";
  if (packing.has_moments) text += spheres ? ",moment_x,moment_y,moment_z" : ",moment";
  if (packing.names_bonds) text += ",bonded,bond_gap";
  text += "\n";
  for (const ForeignContact& c : packing.contacts) {
    const Position& t = c.tangential;
    fmt::format_to(out(text), "{},{},{},{},", packing.id[c.i], packing.id[c.j], c.shift[0],
                   c.shift[1]);
    if (spheres) fmt::format_to(out(text), "{},", c.shift[2]);
    fmt::format_to(out(text), "{},{},{}", c.normal, t[0], t[1]);
    if (spheres) fmt::format_to(out(text), ",{}", t[2]);
    if (packing.has_moments && spheres)
      fmt::format_to(out(text), ",{},{},{}", c.moment[0], c.moment[1], c.moment[2]);
    else if (packing.has_moments)
      fmt::format_to(out(text), ",{}", c.moment[2]);
    if (packing.names_bonds) fmt::format_to(out(text), ",{},{}", c.bonded ? 1 : 0, c.bond_gap);
    text += "\n";
  }
  return text;
}

std::string cell_text(const ForeignPacking& packing) {
  const Lattice& h = packing.cell;
  std::string header, line;
  for (int i = 0; i < packing.dimension; ++i)
    for (int j = 0; j < packing.dimension; ++j) {
      header += fmt::format("H{}{},", i, j);
      line += fmt::format("{},", h[static_cast<std::size_t>(3 * i + j)]);
    }
  if (packing.dimension == 2) {
    header += "thickness,";
    line += fmt::format("{},", packing.thickness());
  }
  if (packing.density) {
    header += "rho,";
    line += fmt::format("{},", *packing.density);
  }
  header.back() = line.back() = '\n';
  return header + line;
}

}  // namespace

double ForeignPacking::volume() const { return Matrix::Map(cell.data()).determinant(); }

Position ForeignPacking::branch(const ForeignContact& contact) const {
  Position l;
  for (std::size_t k = 0; k < 3; ++k) {
    l[k] = centre[contact.j][k] - centre[contact.i][k];
    for (std::size_t m = 0; m < 3; ++m) l[k] += cell[3 * k + m] * contact.shift[m];
  }
  if (dimension == 2) l[2] = 0;
  return l;
}

double ForeignPacking::overlap(const ForeignContact& contact) const {
  const Position l = branch(contact);
  return radius[contact.i] + radius[contact.j] - std::hypot(l[0], l[1], l[2]);
}

Lattice ForeignPacking::stress() const {
  Lattice sigma{};
  for (const ForeignContact& contact : contacts) {
    const Position l = branch(contact);
    const double length = std::hypot(l[0], l[1], l[2]);
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t m = 0; m < 3; ++m)
        sigma[3 * k + m] -=
            (contact.normal * l[k] / length + contact.tangential[k]) * l[m] / volume();
  }
  return sigma;
}

ForeignPacking read_foreign(const ForeignFiles& files) {
  const SourceTable table = read_source(files.particles, files.separator, files.units);
  ForeignPacking packing;
  packing.notes = table.notes;
  read_centres(table, files, packing);
  read_cell(table, files, packing);
  if (!files.contacts.empty()) read_forces(table, files, packing);
  return packing;
}

void write_foreign(const ForeignPacking& packing, const std::string& prefix) {
  write_file(prefix + "_particles.csv", particles_text(packing));
  if (packing.has_contacts) write_file(prefix + "_contacts.csv", contacts_text(packing));
  write_file(prefix + "_cell.csv", cell_text(packing));
}

}  // namespace verification
