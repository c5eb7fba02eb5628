#include "material/packing_file_checks.hpp"

#include "base/error.hpp"
#include "packing/geometry.hpp"
#include "packing/lattice.hpp"
#include "packing/neighbours.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grainlaw {

namespace {

double branch_length(const Packing& packing, const InitialContact& contact) {
  return length<2>(branch<2>(
      packing.position.data(), packing.size(), static_cast<std::size_t>(contact.i),
      static_cast<std::size_t>(contact.j), tensor_of<2>(packing.cell), vec_of<2>(contact.shift)));
}

}  // namespace

void check_sizes(const std::string& path, const ParticleIds& ids, const Packing& packing) {
  const auto id_of = [&](std::int32_t p) {
    return std::ranges::find(ids, p, &ParticleIds::value_type::second)->first;
  };
  const auto wrong = [&](const std::string& what) {
    throw Error(GRAINLAW_BAD_PACKING, fmt::format("{}: {}; expected all lengths in m", path, what));
  };
  const auto& h = packing.cell;
  const double area = determinant<2>(h.data());
  const double height = area / longest_vector(reduced_basis({h[0], h[1], h[2], h[3]}).cell);
  const auto largest = std::ranges::max_element(packing.radius);
  if (!packing.frame && *largest > height)
    wrong(fmt::format("particle {} of radius {:g} m is larger than the cell, {:g} m high",
                      id_of(static_cast<std::int32_t>(largest - packing.radius.begin())), *largest,
                      height));
  std::vector<char> in_row(packing.size(), 0);
  if (packing.frame && !packing.frame->reference.empty())
    for (const int p : packing.frame->boundary) in_row[static_cast<std::size_t>(p)] = 1;
  std::vector<NeighbourPair<2>> pairs;
  const std::size_t n = packing.size();
  NeighbourSearch<2>().find(n, packing.position.data(), packing.radius.data(),
                            packing.frame ? nullptr : h.data(), 0, pairs);
  const auto key = [](const InitialContact& c) { return key_of(c); };
  for (const NeighbourPair<2>& pair : pairs) {
    const InitialContact contact{pair.i, pair.j, {pair.shift[0], pair.shift[1]}};
    const double length = branch_length(packing, contact);
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

void check_branches(const std::string& path, const std::vector<unsigned>& lines,
                    const Packing& packing) {
  for (std::size_t c = 0; c < lines.size(); ++c) {
    const InitialContact& contact = packing.contacts[c];
    const double reach = packing.radius[static_cast<std::size_t>(contact.i)] +
                         packing.radius[static_cast<std::size_t>(contact.j)];
    const double length = branch_length(packing, contact);
    if (!contact.bonded && !(length < 1.5 * reach))
      throw Error(GRAINLAW_BAD_PACKING,
                  fmt::format("{}:{}: centres are {} m apart, radii add up to {} m: these do not "
                              "touch; expected x_j - x_i + H shift to be the branch",
                              path, lines[c], length, reach));
  }
}

}  // namespace grainlaw
