#include "state/output.hpp"

#include "homogenise/measures.hpp"
#include "packing/frame.hpp"
#include "packing/vtk.hpp"

#include <cmath>
#include <span>
#include <vector>

namespace grainlaw {

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
  const auto& F = at.deformation;
  const auto& H = material.packing.cell;
  packing.cell = {F[0] * H[0] + F[1] * H[2], F[0] * H[1] + F[1] * H[3], F[2] * H[0] + F[3] * H[2],
                  F[2] * H[1] + F[3] * H[3]};
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
    if (material.law.bonds()) contact.bonded = c.bonded;
    contact.bond_gap = c.bond_gap;
  }
  if (packing.frame) {
    // Sides that moved on their own are no copies any more.
    const auto& space = material.space;
    for (std::size_t k = 0; k < 2; ++k) {
      if (space.options.type != BoundaryType::frame_d && !space.copied[k]) {
        packing.frame->copies[k] = false;
      }
    }
    complete_frame(packing);
  }
  return packing;
}

}  // namespace grainlaw
