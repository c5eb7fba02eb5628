#include "state/lists.hpp"

#include "homogenise/measures.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace grainlaw::core {

namespace {

// Copies a vector, padded with zeros to three components.
template <class Numbers, class Number>
void put(const Numbers& vector, Number (&to)[3]) {
  std::copy(vector.begin(), vector.end(), to);
}

// Copies an angle or a moment; in the plane it is about axis 3.
void put_about(const std::array<double, 1>& angle, double (&to)[3]) { to[2] = angle[0]; }
void put_about(const std::array<double, 3>& vector, double (&to)[3]) { put(vector, to); }

}  // namespace

template <int D>
std::vector<grainlaw_particle> list_particles(const Material<D>& material,
                                              const Configuration<D>& at) {
  const std::size_t n = material.packing.size();
  const bool rotating = at.coordinates.size() > D * n;
  std::vector<grainlaw_particle> particles(n);
  for (std::size_t p = 0; p < n; ++p) {
    grainlaw_particle& particle = particles[p];
    for (std::size_t k = 0; k < D; ++k) particle.position[k] = at.coordinates[k * n + p];
    if (rotating)
      put_about(rotation_of<D>(at.coordinates.data() + D * n + p, n), particle.rotation);
    particle.radius = material.packing.radius[p];
    particle.source = material.space.source[p];
  }
  for (const auto& contact : at.contacts) {
    ++particles[static_cast<std::size_t>(contact.i)].contacts;
    ++particles[static_cast<std::size_t>(contact.j)].contacts;
  }
  return particles;
}

template <int D>
std::vector<grainlaw_contact> list_contacts(const Material<D>& material,
                                            const Configuration<D>& at) {
  const auto views = contact_views(material.problem(), at);
  std::vector<grainlaw_contact> contacts(views.size());
  for (std::size_t c = 0; c < views.size(); ++c) {
    const auto& view = views[c];
    grainlaw_contact& contact = contacts[c];
    const double distance = length<D>(view.branch);
    put(view.branch, contact.branch);
    for (std::size_t k = 0; k < D; ++k) contact.normal[k] = view.branch[k] / distance;
    contact.overlap = view.overlap;
    contact.normal_force = view.normal_force;
    put(view.tangential_force_vector(), contact.tangential_force);
    put_about(view.moment, contact.moment);
    contact.weight = view.weight;
    contact.i = view.i;
    contact.j = view.j;
    put(view.shift, contact.shift);
    contact.sliding = at.contacts[c].sliding ? 1 : 0;
    contact.bonded = view.bonded ? 1 : 0;
  }
  return contacts;
}

template std::vector<grainlaw_particle> list_particles(const Material<2>&, const Configuration<2>&);
template std::vector<grainlaw_particle> list_particles(const Material<3>&, const Configuration<3>&);
template std::vector<grainlaw_contact> list_contacts(const Material<2>&, const Configuration<2>&);
template std::vector<grainlaw_contact> list_contacts(const Material<3>&, const Configuration<3>&);

}  // namespace grainlaw::core
