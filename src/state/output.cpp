#include "state/output.hpp"

#include "frame/carried_frame.hpp"
#include "homogenise/measures.hpp"
#include "io/vtk.hpp"

#include <span>
#include <vector>

namespace grainlaw::core {

namespace {

// Returns numbers padded with zeros to three components.
template <std::size_t size, class Numbers>
auto filled(const Numbers& numbers) {
  std::array<typename Numbers::value_type, size> result{};
  for (std::size_t k = 0; k < numbers.size(); ++k) result[k] = numbers[k];
  return result;
}

// Scalar of a tangential force: signed along the tangent for discs, the norm for spheres.
double as_number(const std::array<double, 1>& component) { return component[0]; }
double as_number(const Vec<3>& vector) { return length<3>(vector); }

}  // namespace

template <int D>
void write_force_chains(const std::string& path, const Material<D>& material,
                        const Configuration<D>& at) {
  const std::size_t n = material.packing.size();
  std::vector<VtkContact> chains;
  for (const auto& c : contact_views(material.problem(), at))
    chains.push_back({c.i, c.j, filled<3>(c.branch), c.normal_force, as_number(c.tangential_force),
                      as_number(c.moment), c.bonded});
  const std::span<const double> coordinates(at.coordinates);
  constexpr std::size_t spins = Dimension<D>::spins;
  std::vector<double> rotation(coordinates.size() > D * n ? spins * n : 0);
  for (std::size_t p = 0; p < n && !rotation.empty(); ++p) {
    const auto vector = rotation_of<D>(at.coordinates.data() + D * n + p, n);
    for (std::size_t k = 0; k < spins; ++k) rotation[k * n + p] = vector[k];
  }
  write_vtk(path, coordinates.first(D * n), material.packing.radius, rotation, chains);
}

template <int D>
Packing as_packing(const Material<D>& material, const Configuration<D>& at) {
  Packing packing = material.packing;
  if constexpr (D == 2) keep_reference(material.space, at.deformation, packing);
  const auto split = static_cast<std::ptrdiff_t>(packing.position.size());
  packing.position.assign(at.coordinates.begin(), at.coordinates.begin() + split);
  packing.cell = filled<9>(product<D>(at.deformation, tensor_of<D>(packing.cell)));
  packing.contacts.clear();
  for (const auto& c : contact_views(material.problem(), at)) {
    packing.contacts.push_back(
        {c.i, c.j, filled<3>(c.shift), c.normal_force, filled<3>(c.tangential_force_vector())});
    auto& contact = packing.contacts.back();
    contact.moment = filled<3>(c.moment);
    contact.bonded = c.bonded;
    contact.bond_gap = c.bond_gap;
  }
  packing.names_bonds = material.law.bonds();
  if constexpr (D == 2) carry_frame(material.space, at.deformation, packing);
  return packing;
}

template void write_force_chains(const std::string&, const Material<2>&, const Configuration<2>&);
template void write_force_chains(const std::string&, const Material<3>&, const Configuration<3>&);
template Packing as_packing(const Material<2>&, const Configuration<2>&);
template Packing as_packing(const Material<3>&, const Configuration<3>&);

}  // namespace grainlaw::core
