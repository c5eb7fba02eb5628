// Frame columns of a particle file, and the frame that they describe.
#pragma once

#include "packing/packing.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>

namespace grainlaw::core {

using ParticleIds = std::unordered_map<std::int64_t, int>;  // id -> particle

struct FrameRows {
  std::map<std::int64_t, int> particle_at;  // frame_order -> particle
  int corners = 0;
  std::map<int, std::int64_t> partner_id;  // edge particle -> id
};

// Builds the frame of a packing whose particles are read; `frame` has its reference. Throws Error
// (BAD_PACKING) that begins with the path, when the rows describe no frame or the chain has holes.
void build_frame(const std::string& path, const FrameRows& rows, const ParticleIds& ids,
                 Frame frame, Packing& packing);

}  // namespace grainlaw::core
