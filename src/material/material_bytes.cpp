// Layout, little-endian:
//   "GRAINMAT"  u32 version  u32 dimension
//   words of 64 bits: the members of the material in the order below, numbers of entries before lists
//   u64 XXH3 of everything before
#include "material/material_bytes.hpp"

#include "base/error.hpp"
#include "base/saved_bytes.hpp"
#include "material/space_of.hpp"
#include "material/words.hpp"

#include <algorithm>

namespace grainlaw::core {

namespace {

constexpr SavedKind saved_material{"saved material", {'G', 'R', 'A', 'I', 'N', 'M', 'A', 'T'}, 2};

}  // namespace

// Lists of members, for writing (const) and reading. A member that is added changes the size.
template <class T, class Struct>
concept Of = std::is_same_v<std::remove_const_t<T>, Struct>;

void members(auto& words, Of<InitialContact> auto& c) {
  each(words, c.i, c.j, c.shift, c.normal_force, c.tangential_force, c.moment, c.bonded,
       c.bond_gap);
}
void members(auto& words, Of<Frame> auto& f) {
  each(words, f.copies, f.boundary, f.corner, f.partner, f.area, f.reference, f.deformation,
       f.source, f.offset, f.extent);
}
void members(auto& words, Of<Packing> auto& p) {
  each(words, p.dimension, p.thickness, p.density, p.cell, p.position, p.radius, p.contacts,
       p.names_bonds, p.order, p.frame);
}
void members(auto& words, Of<RollingResistance> auto& r) {
  each(words, r.ratio, r.friction, r.twisting_ratio, r.twisting_friction);
}
void members(auto& words, Of<Bond> auto& b) {
  each(words, b.normal_stiffness, b.tangential_stiffness, b.normal_strength, b.tangential_strength,
       b.bending_strength, b.bending_stiffness, b.torsion_strength, b.torsion_stiffness, b.gap);
}
void members(auto& words, Of<ContactLaw> auto& l) {
  each(words, l.kind, l.young, l.normal_stiffness, l.ratio, l.friction, l.rotation, l.shear_modulus,
       l.poisson, l.rolling, l.bond, l.typical_overlap);
}
void members(auto& words, Of<Side> auto& s) { each(words, s.x, s.y, s.rotation, s.row); }
void members(auto& words, Of<ServoOptions> auto& s) {
  each(words, s.gain_force, s.gain_moment, s.gain_deformation, s.inheritance, s.tolerance,
       s.tolerance_deformation, s.max_corrections);
}
void members(auto& words, Of<BoundaryOptions> auto& b) {
  each(words, b.type, b.method, b.weight, b.sides, b.inner_rotation, b.stress, b.servo);
}
void members(auto& words, Of<Viscosity> auto& v) { each(words, v.number, v.rate, v.steps); }
void members(auto& words, Of<PublishedOptions> auto& p) {
  each(words, p.damping, p.time_step_ratio, p.energy_tolerance, p.max_steps);
}
void members(auto& words, Of<SolverOptions> auto& s) {
  each(words, s.tolerance, s.loose_tolerance, s.start, s.method, s.force_floor, s.increment_limit,
       s.contacts_lost, s.viscosity, s.inertia, s.published);
}
template <class T>
concept AnyHistory = Of<T, ContactHistory<2>> || Of<T, ContactHistory<3>>;
void members(auto& words, AnyHistory auto& h) {
  each(words, h.i, h.j, h.shift, h.sliding, h.bonded, h.tangential_force);
}
template <class T>
concept AnyConfiguration = Of<T, Configuration<2>> || Of<T, Configuration<3>>;
void members(auto& words, AnyConfiguration auto& c) {
  each(words, c.deformation, c.coordinates, c.contacts, c.stress, c.dissipated, c.moments,
       c.bond_gaps, c.broken_bonds, c.velocity, c.strain_rate);
}
template <class T>
concept AnyOfMaterial = Of<T, Material<2>> || Of<T, Material<3>>;
void members(auto& words, AnyOfMaterial auto& m) {
  each(words, m.packing, m.law, m.space.options, m.solver, m.initial, m.initial_mean_force,
       m.fingerprint);
}

#if defined(__x86_64__) && defined(__GLIBCXX__)
static_assert(sizeof(InitialContact) == 96 && sizeof(Frame) == 224 && sizeof(Packing) == 432);
static_assert(sizeof(ContactLaw) == 176 && sizeof(BoundaryOptions) == 200);
static_assert(sizeof(SolverOptions) == 112 && sizeof(Configuration<3>) == 352);
#endif

namespace {

template <int D>
std::shared_ptr<const Material<D>> read(WordReader& words) {
  auto material = std::make_shared<Material<D>>();
  words.one(*material);
  const Packing& packing = material->packing;
  const std::size_t n = packing.size();
  const auto inside = [=](int particle) {
    return particle >= 0 && static_cast<std::size_t>(particle) < n;
  };
  const bool fits = words.left() == 0 && packing.dimension == D &&
                    packing.position.size() == D * n &&
                    material->initial.coordinates.size() >= D * n &&
                    (packing.order.empty() || packing.order.size() == n) &&
                    std::ranges::all_of(packing.order, inside) &&
                    std::ranges::all_of(material->initial.contacts, [&](const auto& contact) {
                      return inside(contact.i) && inside(contact.j);
                    });
  if (!fits) throw Error(GRAINLAW_BAD_BYTES, "saved material: its content does not fit together");
  material->space = space_of<D>(packing, material->space.options);
  return material;
}

}  // namespace

template <int D>
std::vector<std::byte> save_material(const Material<D>& material) {
  WordWriter writer;
  writer.one(material);
  std::vector<std::byte> bytes(version_end + sizeof(std::uint32_t) +
                               sizeof(std::uint64_t) * writer.words.size() + checksum_size);
  ByteWriter out(bytes);
  out.begin(saved_material);
  out.put(std::uint32_t{D});
  for (const std::uint64_t word : writer.words) out.put(word);
  out.end();
  return bytes;
}

std::uint64_t checksum_of_saved(std::span<const std::byte> bytes) {
  return ByteReader(bytes.last(checksum_size)).get<std::uint64_t>();
}

std::variant<std::shared_ptr<const Material<2>>, std::shared_ptr<const Material<3>>>
load_saved_material(std::span<const std::byte> bytes) {
  check_envelope(bytes, saved_material);
  ByteReader in(bytes.first(bytes.size() - checksum_size).subspan(version_end));
  const auto dimension = in.left() < sizeof(std::uint32_t) ? 0 : in.get<std::uint32_t>();
  if ((dimension != 2 && dimension != 3) || in.left() % sizeof(std::uint64_t) != 0)
    throw Error(GRAINLAW_BAD_BYTES, "saved material: its length does not fit its content");
  std::vector<std::uint64_t> words(in.left() / sizeof(std::uint64_t));
  for (std::uint64_t& word : words) word = in.get<std::uint64_t>();
  WordReader reader(words);
  if (dimension == 2) return read<2>(reader);
  return read<3>(reader);
}

template std::vector<std::byte> save_material(const Material<2>&);
template std::vector<std::byte> save_material(const Material<3>&);

}  // namespace grainlaw::core
