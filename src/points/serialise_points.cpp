// Layout, little-endian:
//   "GRAINPTS"  u32 version  u64 points
//   of each point: u64 size  the bytes of its state
//   u64 XXH3 of everything before
#include "points/serialise_points.hpp"

#include "base/error.hpp"
#include "state/saved_bytes.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace grainlaw::core {

namespace {

constexpr SavedKind kind{"saved points", {'G', 'R', 'A', 'I', 'N', 'P', 'T', 'S'}, 1};

[[noreturn]] void fail_truncated(std::size_t point) {
  throw Error(GRAINLAW_BAD_BYTES, fmt::format("saved points: they end at point {}", point));
}

SavedState read_point(const IntegrationPoint& point, std::size_t number, ByteReader& in) {
  if (in.left() < sizeof(std::uint64_t)) fail_truncated(number);
  const auto size = in.get<std::uint64_t>();
  if (size > in.left()) fail_truncated(number);
  try {
    return point.state.read(in.take(size));
  } catch (const Error& error) {
    throw Error(error.status, fmt::format("point {}: {}", number, error.what()));
  }
}

}  // namespace

std::size_t saved_size(PointSpan points) {
  std::size_t size = version_end + sizeof(std::uint64_t) + checksum_size;
  for (const IntegrationPoint* point : points)
    size += sizeof(std::uint64_t) + point->state.saved_size();
  return size;
}

void save_points(PointSpan points, std::span<std::byte> bytes) {
  ByteWriter out(bytes);
  out.begin(kind);
  out.put(std::uint64_t{points.size()});
  for (const IntegrationPoint* point : points) {
    const std::size_t size = point->state.saved_size();
    out.put(std::uint64_t{size});
    point->state.save(out.skip(size));
  }
  out.end();
}

void load_points(PointSpan points, std::span<const std::byte> bytes) {
  if (points.size() == 1 && begin_as(bytes, saved_state)) {
    AnyState& only = points.front()->state;
    only.restore(only.read(bytes));
    return;
  }
  check_envelope(bytes, kind);
  ByteReader in(bytes.first(bytes.size() - checksum_size).subspan(version_end));
  if (in.left() < sizeof(std::uint64_t)) fail_truncated(0);
  if (const auto count = in.get<std::uint64_t>(); count != points.size())
    throw Error(GRAINLAW_BAD_ARGUMENT,
                fmt::format("saved points: {} points, expected {}", count, points.size()));
  std::vector<SavedState> found;
  found.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) found.push_back(read_point(*points[k], k, in));
  if (in.left() != 0) throw Error(GRAINLAW_BAD_BYTES, "saved points: there is more behind them");
  for (std::size_t k = 0; k < points.size(); ++k) points[k]->state.restore(std::move(found[k]));
}

}  // namespace grainlaw::core
