// Layout, little-endian; doubles unless stated:
//   "GRAINLAW"  u32 version  u32 contacts  u64 material fingerprint;
//   F [dim*dim]  P [dim*dim]  dissipated  [broken bonds];
//   coordinates [number of the material's];
//   contacts: i32 i  i32 j  i16 shift[dim]  u8 1 sliding, 2 bonded;
//             tangential force, of spheres three  [moment]  [gap of the bond];
//   [mean strain rate  velocities of the drag's masses, or of the particles  time step];
//   [F of the packing where that of the host is I, dim*dim];
//   u64 XXH3 of everything before.
// Parts in brackets exist only with a law that has bonds, moments, drag or inertia, and of a state
// that was consolidated. Versions: 2, with velocities 4, consolidated 5, both 6; 3 was of an
// earlier drag.
#include "state/serialise.hpp"

#include "base/error.hpp"
#include "base/saved_bytes.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

namespace grainlaw::core {
namespace {

constexpr std::size_t header_size = version_end + sizeof(std::uint32_t) + sizeof(std::uint64_t);
template <int D>
constexpr std::size_t reference_size = sizeof(double) * squared<D>;
template <int D>
constexpr std::size_t plain_contact_size =
    2 * sizeof(std::int32_t) + D * sizeof(std::int16_t) +
    sizeof(std::uint8_t) + Dimension<D>::tangents * sizeof(double);

// Version of the bytes, which tells of a reference.
std::uint32_t version_of(bool velocities, bool reference) {
  if (reference) return velocities ? 6 : 5;
  return velocities ? 4 : saved_state.version;
}

// Number of doubles of the velocities: of positions, and rotations as vectors.
template <int D>
std::size_t velocities(const Material<D>& material) {
  return D == 3 ? Dimension<D>::unknowns * material.packing.size()
                : material.initial.coordinates.size();
}

template <int D>
std::size_t size_without_contacts(const Material<D>& material) {
  const std::size_t moving =
      material.solver.keeps_velocities() ? squared<D> + velocities(material) + 1 : 0;
  return header_size + checksum_size +
         sizeof(double) * (2 * squared<D> + (material.law.bonds() ? 2 : 1) +
                           material.initial.coordinates.size() + moving);
}

template <int D>
std::size_t contact_size(const Material<D>& material) {
  const std::size_t moments = material.law.moments() ? Dimension<D>::spins : 0;
  return plain_contact_size<D> + sizeof(double) * (moments + (material.law.bonds() ? 1U : 0U));
}

void require(bool condition, grainlaw_status status, const char* found) {
  if (!condition) throw Error(status, std::string("saved state: ") + found);
}

// Fails unless contacts are sorted as the contact list keeps them: i <= j, ascending (i, j, shift),
// each once.
template <int D>
void check_contacts(const std::vector<ContactHistory<D>>& contacts, std::size_t particles) {
  constexpr std::array<std::int16_t, static_cast<std::size_t>(D)> none{};
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto& [i, j, shift, sliding, bonded, force] = contacts[c];
    require(i >= 0 && i <= j && static_cast<std::size_t>(j) < particles, GRAINLAW_BAD_BYTES,
            "a contact of particles that do not exist");
    require(i != j || shift > none, GRAINLAW_BAD_BYTES, "a contact of a particle with itself");
    require(c == 0 || key_of(contacts[c - 1]) < key_of(contacts[c]), GRAINLAW_BAD_BYTES,
            "contacts out of order");
  }
}

}  // namespace

template <int D>
std::size_t saved_size(const Material<D>& material, const Configuration<D>& configuration,
                       const std::optional<Reference<D>>& reference) {
  return size_without_contacts(material) + configuration.contacts.size() * contact_size(material) +
         (reference ? reference_size<D> : 0);
}

template <int D>
void save_configuration(const Material<D>& material, const Configuration<D>& configuration,
                        std::span<std::byte> bytes, double time_step,
                        const std::optional<Reference<D>>& reference) {
  const std::size_t spins = material.law.moments() ? Dimension<D>::spins : 0;
  ByteWriter out(bytes);
  SavedKind written = saved_state;
  written.version = version_of(material.solver.keeps_velocities(), reference.has_value());
  out.begin(written);
  out.put(static_cast<std::uint32_t>(configuration.contacts.size()));
  out.put(material.fingerprint);
  for (std::size_t k = 0; k < squared<D>; ++k) out.put(configuration.deformation[k]);
  for (std::size_t k = 0; k < squared<D>; ++k) out.put(configuration.stress[k]);
  out.put(configuration.dissipated);
  if (material.law.bonds()) out.put(configuration.broken_bonds);
  for (const double coordinate : configuration.coordinates) out.put(coordinate);
  for (std::size_t c = 0; c < configuration.contacts.size(); ++c) {
    const ContactHistory<D>& contact = configuration.contacts[c];
    out.put(contact.i);
    out.put(contact.j);
    for (const std::int16_t shift : contact.shift) out.put(shift);
    out.put(static_cast<std::uint8_t>((contact.sliding ? 1 : 0) + (contact.bonded ? 2 : 0)));
    for (const double component : contact.tangential_force) out.put(component);
    for (std::size_t k = 0; k < spins; ++k) out.put(configuration.moments[spins * c + k]);
    if (material.law.bonds()) {
      out.put(configuration.bond_gaps.empty() ? 0.0 : configuration.bond_gaps[c]);
    }
  }
  if (material.solver.keeps_velocities()) {
    for (const double component : configuration.strain_rate) out.put(component);
    for (std::size_t k = 0; k < velocities(material); ++k) {
      out.put(configuration.velocity.empty() ? 0.0 : configuration.velocity[k]);
    }
    out.put(time_step);
  }
  if (reference)
    for (const double component : reference->deformation()) out.put(component);
  out.end();
}

template <int D>
SavedStateOf<D> load_configuration(const Material<D>& material, std::span<const std::byte> bytes) {
  check_envelope(bytes, saved_state);
  require(bytes.size() >= header_size + checksum_size, GRAINLAW_BAD_BYTES, "truncated");
  ByteReader in(bytes.subspan(sizeof(SavedKind::letters)));
  const auto version = in.get<std::uint32_t>();
  const std::size_t contacts = in.get<std::uint32_t>();
  require(in.get<std::uint64_t>() == material.fingerprint, GRAINLAW_WRONG_MATERIAL,
          "of another material");
  const bool has_reference = version == version_of(material.solver.keeps_velocities(), true);
  require(has_reference || version == version_of(material.solver.keeps_velocities(), false),
          GRAINLAW_WRONG_VERSION, "of another format version");
  require(!has_reference || !material.space.finds_deformation, GRAINLAW_WRONG_MATERIAL,
          "consolidated, which boundary.stress does not take");
  const std::size_t fixed_size =
      size_without_contacts(material) + (has_reference ? reference_size<D> : 0);
  require(
      bytes.size() >= fixed_size && bytes.size() - fixed_size == contacts * contact_size(material),
      GRAINLAW_BAD_BYTES, "its length does not fit its content");

  SavedStateOf<D> saved;
  Configuration<D>& found = saved.committed;
  for (std::size_t k = 0; k < squared<D>; ++k) found.deformation[k] = in.get_finite();
  for (std::size_t k = 0; k < squared<D>; ++k) found.stress[k] = in.get_finite();
  found.dissipated = in.get_finite();
  if (material.law.bonds()) found.broken_bonds = in.get_finite();
  found.coordinates.resize(material.initial.coordinates.size());
  for (double& coordinate : found.coordinates) coordinate = in.get_finite();
  const std::size_t spins = material.law.moments() ? Dimension<D>::spins : 0;
  found.contacts.resize(contacts);
  for (ContactHistory<D>& contact : found.contacts) {
    contact.i = in.get<std::int32_t>();
    contact.j = in.get<std::int32_t>();
    for (std::int16_t& shift : contact.shift) shift = in.get<std::int16_t>();
    const auto status = in.get<std::uint8_t>();
    require(status <= (material.law.bonds() ? 2 : 1), GRAINLAW_BAD_BYTES,
            "a contact neither sliding nor sticking nor bonded");
    contact.sliding = status == 1;
    contact.bonded = status == 2;
    for (double& component : contact.tangential_force) component = in.get_finite();
    for (std::size_t k = 0; k < spins; ++k) found.moments.push_back(in.get_finite());
    if (material.law.bonds()) found.bond_gaps.push_back(in.get_finite());
  }
  double& step = saved.time_step;
  if (material.solver.keeps_velocities()) {
    for (double& component : found.strain_rate) component = in.get_finite();
    found.velocity.resize(velocities(material));
    for (double& component : found.velocity) component = in.get_finite();
    step = in.get_finite();
  }
  require(step >= 0 || step == untold, GRAINLAW_BAD_BYTES, "a time step below 0");
  if (has_reference) {
    Tensor<D> deformation{};
    for (double& component : deformation) component = in.get_finite();
    require(determinant<D>(deformation) > 0, GRAINLAW_BAD_BYTES, "det F <= 0");
    saved.reference.emplace(deformation);
  }
  const auto none = [](double gap) { return gap == 0; };
  if (std::all_of(found.bond_gaps.begin(), found.bond_gaps.end(), none)) found.bond_gaps.clear();
  require(determinant<D>(found.deformation) > 0, GRAINLAW_BAD_BYTES, "det F <= 0");
  check_contacts<D>(found.contacts, material.packing.size());
  return saved;
}

#define GRAINLAW_FOR(D)                                                         \
  template std::size_t saved_size(const Material<D>&, const Configuration<D>&,  \
                                  const std::optional<Reference<D>>&);          \
  template void save_configuration(const Material<D>&, const Configuration<D>&, \
                                   std::span<std::byte>, double,                \
                                   const std::optional<Reference<D>>&);         \
  template SavedStateOf<D> load_configuration(const Material<D>&, std::span<const std::byte>);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace grainlaw::core
