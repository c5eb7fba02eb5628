#include "import/balance.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace verification {

using Vector = Eigen::Vector3d;

double force_left(const ForeignPacking& packing, double sign) {
  std::vector<Vector> on(packing.radius.size(), Vector::Zero());
  std::vector<bool> pressed(on.size(), false);
  double size = 0;
  for (const ForeignContact& c : packing.contacts) {
    const Vector normal = Vector::Map(packing.branch(c).data()).normalized();
    const Vector force = c.normal * normal + sign * Vector::Map(c.tangential.data());
    on[c.j] += force;
    on[c.i] -= force;
    pressed[c.i] = pressed[c.j] = true;
    size += force.norm() / static_cast<double>(packing.contacts.size());
  }
  double left = 0;
  int count = 0;
  for (std::size_t p = 0; p < on.size(); ++p) {
    if (!pressed[p] || (!packing.at_wall.empty() && packing.at_wall[p])) continue;
    left += on[p].norm();
    ++count;
  }
  return size > 0 && count > 0 ? left / count / size : 0;
}

void settle_signs(const SourceTable& table, bool parted, ForeignPacking& packing) {
  constexpr double most = 0.05;      // of a packing at rest, with room for one that creeps
  constexpr double rounding = 1e-9;  // where both ways balance
  double sign = parted && table.lammps ? -1 : 1;
  double left = force_left(packing, sign);
  const double reversed = parted ? force_left(packing, -sign) : left;
  if (std::min(left, reversed) > most) {
    const std::string other =
        parted ? fmt::format(", and {:.3g} of it with the tangential ones on the other particle",
                             reversed)
               : std::string();
    table.fail(fmt::format(
        "found forces that leave on a particle {:.3g} of the force of a contact{}; expected at "
        "most {:g}: particles at rest, all of their contacts, and their tangential forces too "
        "(ftx, fty, ftz; of LAMMPS p1, p2, p3, its fx, fy, fz are the normal part)",
        left, other, most));
  }
  if (reversed + rounding < 0.5 * left) {
    sign = -sign;
    left = reversed;
  }
  if (sign < 0) {
    packing.notes.emplace_back(
        "tangential forces in the file act on the first particle of a contact");
    for (ForeignContact& c : packing.contacts)
      for (std::size_t k = 0; k < 3; ++k) {
        c.tangential[k] = -c.tangential[k];
        c.moment[k] = -c.moment[k];
      }
  }
  packing.read.push_back(fmt::format(
      "forces that balance: {:.2g} of the force of a contact is left on a particle", left));
}

}  // namespace verification
