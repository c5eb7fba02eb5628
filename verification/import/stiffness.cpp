// The stiffness that contacts of a file share.
#include "import/foreign_packing.hpp"

#include <cmath>
#include <vector>

namespace verification {
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
  // Ratios of sums over all contacts, so that small overlaps of rounded centres weigh little.
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
