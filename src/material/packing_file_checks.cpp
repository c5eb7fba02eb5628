#include "material/packing_file_checks.hpp"

#include "base/error.hpp"
#include "material/contact_lines.hpp"
#include "packing/geometry.hpp"
#include "packing/lattice.hpp"
#include "packing/neighbours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainlaw::core {

namespace {

template <int D>
double branch_length(const Packing& packing, const InitialContact& contact) {
  return length<D>(branch<D>(
      packing.position.data(), packing.size(), static_cast<std::size_t>(contact.i),
      static_cast<std::size_t>(contact.j), tensor_of<D>(packing.cell), vec_of<D>(contact.shift)));
}

// Smallest height of the cell, in the shortest basis of a plane lattice [m].
double height_of(const Tensor<2>& h) {
  return determinant<2>(h) / longest_vector(reduced_basis(h).cell);
}
double height_of(const Tensor<3>& h) {
  const Tensor<3> inverted = inverse<3>(h);
  double height = 1e300;
  for (std::size_t k = 0; k < 3; ++k) {
    height = std::min(height, 1 / std::sqrt(dot<3>(&inverted[3 * k], &inverted[3 * k])));
  }
  return height;
}

}  // namespace

template <int D>
void check_sizes(const std::string& path, const ParticleIds& ids, const Packing& packing) {
  const auto id_of = [&](std::int32_t p) {
    return std::ranges::find(ids, p, &ParticleIds::value_type::second)->first;
  };
  const auto wrong = [&](const std::string& what) {
    throw Error(GRAINLAW_BAD_PACKING,
                fmt::format("{}: {}; expected all lengths in m, and the cell of these particles",
                            path, what));
  };
  const double height = height_of(tensor_of<D>(packing.cell));
  const auto largest = std::ranges::max_element(packing.radius);
  if (!packing.frame && *largest > height)
    wrong(fmt::format("particle {} of radius {:g} m is larger than the cell, {:g} m high",
                      id_of(static_cast<std::int32_t>(largest - packing.radius.begin())), *largest,
                      height));
  std::vector<char> in_row(packing.size(), 0);
  if (packing.frame && !packing.frame->reference.empty())
    for (const int p : packing.frame->boundary) in_row[static_cast<std::size_t>(p)] = 1;
  std::vector<NeighbourPair<D>> pairs;
  const std::size_t n = packing.size();
  NeighbourSearch<D>().find(n, packing.position.data(), packing.radius.data(),
                            packing.frame ? nullptr : packing.cell.data(), 0, pairs);
  const auto key = [](const InitialContact& c) { return key_of(c); };
  for (const NeighbourPair<D>& pair : pairs) {
    InitialContact contact{pair.i, pair.j};
    std::copy(pair.shift.begin(), pair.shift.end(), contact.shift.begin());
    const double length = branch_length<D>(packing, contact);
    const auto i = static_cast<std::size_t>(pair.i);
    const auto j = static_cast<std::size_t>(pair.j);
    const double r = packing.radius[i];
    const double s = packing.radius[j];
    if (!(length < std::max(r, s)) || (in_row[i] && in_row[j])) continue;
    if (!std::ranges::binary_search(packing.contacts, key_of(contact), {}, key))
      wrong(fmt::format("particles {} and {} of radii {:g} and {:g} m are {:g} m apart",
                        id_of(pair.i), id_of(pair.j), r, s, length));
  }
}

template <int D>
void check_branches(const std::string& path, const std::vector<unsigned>& lines,
                    const Packing& packing) {
  for (std::size_t c = 0; c < lines.size(); ++c) {
    const InitialContact& contact = packing.contacts[c];
    const double reach = packing.radius[static_cast<std::size_t>(contact.i)] +
                         packing.radius[static_cast<std::size_t>(contact.j)];
    const double length = branch_length<D>(packing, contact);
    if (!contact.bonded && !(length < 1.5 * reach))
      throw Error(GRAINLAW_BAD_PACKING,
                  fmt::format("{}:{}: centres are {} m apart, radii add up to {} m: these do not "
                              "touch; expected x_j - x_i + H shift to be the branch, with the cell "
                              "H of this packing",
                              path, lines[c], length, reach));
  }
}

#define GRAINLAW_FOR(D)                                                                 \
  template void check_sizes<D>(const std::string&, const ParticleIds&, const Packing&); \
  template void check_branches<D>(const std::string&, const std::vector<unsigned>&, const Packing&);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core
