#include "frame/frame_rows.hpp"

#include "base/error.hpp"
#include "frame/frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainlaw::core {

namespace {

constexpr std::int64_t no_partner = -1;

// Fails where a hole in the chain would let the smallest particle through.
void check_holes(const Packing& packing) {
  const auto& boundary = packing.frame->boundary;
  const std::size_t n = packing.size();
  const auto& position = undeformed(packing);
  const double smallest = *std::min_element(packing.radius.begin(), packing.radius.end());
  for (std::size_t q = 0; q < boundary.size(); ++q) {
    const auto a = static_cast<std::size_t>(boundary[q]);
    const auto b = static_cast<std::size_t>(boundary[(q + 1) % boundary.size()]);
    const double gap = std::hypot(position[b] - position[a], position[n + b] - position[n + a]) -
                       packing.radius[a] - packing.radius[b];
    if (!(gap < 2 * smallest))
      throw Error(GRAINLAW_BAD_PACKING,
                  fmt::format("frame: the boundary has a hole of {} m after frame_order {}, which "
                              "lets particles of radius {} m through; expected neighbours in the "
                              "boundary to be near-contacts",
                              gap, q, smallest));
  }
}

// Opposite sides are copies when their edges name partners; sides without edges follow the others.
void find_copies(const FrameRows& rows, Frame& frame) {
  const auto corner = corner_indices(frame);
  const auto given = [&](std::size_t side) {
    const std::size_t end = side < 3 ? corner[side + 1] : frame.boundary.size();
    int partners = 0;
    for (std::size_t q = corner[side] + 1; q < end; ++q)
      partners += rows.partner_id.at(frame.boundary[q]) != no_partner ? 1 : 0;
    return std::pair(static_cast<int>(end - corner[side]) - 1, partners);
  };
  std::array<int, 2> edges{}, partners{};  // by pairs: left with right, bottom with top
  for (std::size_t side = 0; side < 4; ++side) {
    const auto [count, named] = given(side);
    edges[(side + 1) % 2] += count;
    partners[(side + 1) % 2] += named;
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t by = edges[k] > 0 ? k : 1 - k;
    frame.copies[k] = edges[by] == 0 || partners[by] > 0;
  }
}

}  // namespace

void build_frame(const std::string& path, const FrameRows& rows, const ParticleIds& ids,
                 Frame frame, Packing& packing) {
  const auto wrong = [&](const std::string& message) {
    throw Error(GRAINLAW_BAD_PACKING, fmt::format("{}: {}", path, message));
  };
  if (rows.corners != 4)
    wrong(fmt::format("found {} particles of role 'corner', expected 4", rows.corners));
  std::int64_t expected = 0;
  for (const auto& [order, particle] : rows.particle_at)
    if (order != expected++)
      wrong(fmt::format("frame_order has no {}, expected 0 to {} without a gap", expected - 1,
                        rows.particle_at.size() - 1));
  std::size_t corners = 0;
  for (const auto& [order, particle] : rows.particle_at) {
    frame.boundary.push_back(particle);
    if (!rows.partner_id.contains(particle)) frame.corner[corners++] = particle;
  }
  packing.frame = std::move(frame);
  try {
    check_holes(packing);
    find_copies(rows, *packing.frame);
    complete_frame(packing);
  } catch (const Error& error) {
    wrong(error.what());
  }
  for (std::size_t q = 0; q < packing.frame->boundary.size(); ++q) {
    const auto given = rows.partner_id.find(packing.frame->boundary[q]);
    if (given == rows.partner_id.end()) continue;
    const auto found = ids.find(given->second);
    const int partner = found == ids.end() ? -1 : found->second;
    const bool none = packing.frame->partner[q] < 0;
    if (none ? given->second != no_partner : partner != packing.frame->partner[q])
      wrong(
          fmt::format("the particle at frame_order {} has partner {}, expected its opposite copy "
                      "(or -1 on both sides that are no copies)",
                      q, given->second));
  }
}

}  // namespace grainlaw::core
