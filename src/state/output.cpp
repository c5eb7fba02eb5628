#include "state/output.hpp"

#include "frame/frame.hpp"
#include "homogenise/measures.hpp"
#include "io/vtk.hpp"

#include <cmath>
#include <span>
#include <vector>

namespace grainlaw {

namespace {

using Matrix = std::array<double, 4>;

Matrix product(const Matrix& a, const Matrix& b) {
  return {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2],
          a[2] * b[1] + a[3] * b[3]};
}

// Whether the conditions on a frame that starts from this state would be those of the material:
// fluctuations that average to nothing, or keep to axes, are relative to where they were counted from.
bool is_its_own_reference(const BoundarySpace& space, const Matrix& F) {
  return F == Matrix{1, 0, 0, 1} && !space.averages() && !space.bound_to_axes();
}

}  // namespace

void write_force_chains(const std::string& path, const Material& material,
                        const Configuration& at) {
  const std::size_t n = material.packing.size();
  std::vector<VtkContact> chains;
  for (const ContactView& c : contact_views(material.problem(), at))
    chains.push_back({c.i,
                      c.j,
                      {c.branch_x, c.branch_y, 0},
                      c.normal_force,
                      c.tangential_force,
                      c.moment,
                      c.bonded});
  const std::span<const double> coordinates(at.coordinates);
  write_vtk(path, coordinates.first(2 * n), material.packing.radius, coordinates.subspan(2 * n),
            chains);
}

Packing as_packing(const Material& material, const Configuration& at) {
  Packing packing = material.packing;
  const auto split = static_cast<std::ptrdiff_t>(packing.position.size());
  packing.position.assign(at.coordinates.begin(), at.coordinates.begin() + split);
  const auto& H = material.packing.cell;
  const std::array F{at.deformation[0], at.deformation[1], at.deformation[2], at.deformation[3]};
  const auto cell = product(F, {H[0], H[1], H[2], H[3]});
  packing.cell = {cell[0], cell[1], cell[2], cell[3]};
  packing.contacts.clear();
  for (const ContactView& c : contact_views(material.problem(), at)) {
    const double per_length = c.tangential_force / std::hypot(c.branch_x, c.branch_y);
    packing.contacts.push_back({c.i,
                                c.j,
                                {c.shift[0], c.shift[1]},
                                c.normal_force,
                                {-c.branch_y * per_length, c.branch_x * per_length}});
    auto& contact = packing.contacts.back();
    contact.moment = c.moment;
    contact.bonded = c.bonded;
    contact.bond_gap = c.bond_gap;
  }
  packing.names_bonds = material.law.bonds();
  if (packing.frame && !is_its_own_reference(material.space, F)) {
    Frame& frame = *packing.frame;
    if (frame.reference.empty()) frame.reference = material.packing.position;
    frame.deformation = product(F, frame.deformation);
    complete_frame(packing);
  }
  return packing;
}

}  // namespace grainlaw
