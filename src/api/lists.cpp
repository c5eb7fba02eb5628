// Particles and contacts of a state, as arrays of callers compiled against this header or an
// earlier one.
#include "api/guard.hpp"
#include "api/handle.hpp"

#include <grainlaw/grainlaw.h>

#include <cstddef>
#include <cstring>
#include <vector>

using namespace grainlaw::core;

namespace {

// Sizes of the records in the version that introduced them; later versions only append.
constexpr std::size_t first_particle_size =
    offsetof(grainlaw_particle, contacts) + sizeof(grainlaw_particle::contacts);
constexpr std::size_t first_contact_size =
    offsetof(grainlaw_contact, bonded) + sizeof(grainlaw_contact::bonded);

// Copies the records that find(state) returns to the caller's array.
template <class Record, class Find>
grainlaw_status list(const grainlaw_state* handle, Record* records, std::size_t record_size,
                     std::size_t first_size, std::size_t* count, Find&& find) {
  if (const auto status = api::check_handle(handle); status != GRAINLAW_OK) return status;
  if (count == nullptr) return GRAINLAW_NULL_POINTER;
  if (record_size < first_size || record_size > sizeof(Record)) return GRAINLAW_BAD_ARGUMENT;
  return api::guarded([&] {
    const std::vector<Record> found = find(handle->point.state);
    if (records != nullptr) {
      if (*count < found.size()) return GRAINLAW_BUFFER_TOO_SMALL;
      auto* to = reinterpret_cast<char*>(records);
      for (const Record& record : found) {
        std::memcpy(to, &record, record_size);
        to += record_size;
      }
    }
    *count = found.size();
    return GRAINLAW_OK;
  });
}

}  // namespace

grainlaw_status grainlaw_state_particles(const grainlaw_state* handle, grainlaw_particle* particles,
                                         size_t particle_size, size_t* count) {
  return list(handle, particles, particle_size, first_particle_size, count,
              [](const AnyState& state) { return state.particles(); });
}

grainlaw_status grainlaw_state_contacts(const grainlaw_state* handle, grainlaw_contact* contacts,
                                        size_t contact_size, size_t* count) {
  return list(handle, contacts, contact_size, first_contact_size, count,
              [](const AnyState& state) { return state.contacts(); });
}
