// Layout, little-endian. Of a point: the bytes of its state; where it has a tangent behind them
//   "GRAINTAN"  u32 version  u32 kind  A [dim^4] doubles  u64 XXH3 of this tangent.
// Of a set:
//   "GRAINPTS"  u32 version  u64 points
//   of each point: u64 size  its bytes
//   u64 XXH3 of everything before
// Sets of version 1 have no tangents.
#include "points/serialise_points.hpp"

#include "base/error.hpp"
#include "base/saved_bytes.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <utility>

namespace grainlaw::core {

namespace {

constexpr std::uint32_t newest_set = 2;
constexpr SavedKind saved_set{
    "saved points", {'G', 'R', 'A', 'I', 'N', 'P', 'T', 'S'}, 1, newest_set};
constexpr SavedKind saved_tangent{"saved tangent", {'G', 'R', 'A', 'I', 'N', 'T', 'A', 'N'}, 1};

std::size_t tangent_numbers(const IntegrationPoint& point) {
  const auto square = static_cast<std::size_t>(point.state.dimension() * point.state.dimension());
  return square * square;
}

std::size_t tangent_size(const IntegrationPoint& point) {
  return version_end + sizeof(std::uint32_t) + sizeof(double) * tangent_numbers(point) +
         checksum_size;
}

KeptTangent read_tangent(std::span<const std::byte> bytes, std::size_t numbers) {
  check_envelope(bytes, saved_tangent);
  ByteReader in(bytes.subspan(version_end));
  KeptTangent tangent;
  const auto kind = in.get<std::uint32_t>();
  if (kind == 0 || kind > static_cast<std::uint32_t>(TangentKind::perturbed))
    throw Error(GRAINLAW_BAD_BYTES, "saved tangent: of an unknown kind");
  tangent.kind = static_cast<TangentKind>(kind);
  tangent.values.resize(numbers);
  for (double& value : tangent.values) value = in.get_finite();
  return tangent;
}

[[noreturn]] void fail_truncated(std::size_t point) {
  throw Error(GRAINLAW_BAD_BYTES, fmt::format("saved points: they end at point {}", point));
}

}  // namespace

std::size_t saved_size(const IntegrationPoint& point) {
  const bool has_tangent = point.committed_tangent.kind != TangentKind::none;
  return point.state.saved_size() + (has_tangent ? tangent_size(point) : 0);
}

void save_point(const IntegrationPoint& point, std::span<std::byte> bytes) {
  const std::size_t size = point.state.saved_size();
  point.state.save(bytes.first(size));
  const KeptTangent& tangent = point.committed_tangent;
  if (tangent.kind == TangentKind::none) return;
  ByteWriter out(bytes.subspan(size));
  out.begin(saved_tangent);
  out.put(static_cast<std::uint32_t>(tangent.kind));
  for (const double value : tangent.values) out.put(value);
  out.end();
}

SavedPoint read_point(const IntegrationPoint& point, std::span<const std::byte> bytes) {
  SavedPoint saved;
  const std::size_t behind = tangent_size(point);
  if (bytes.size() > behind && begin_as(bytes.last(behind), saved_tangent)) {
    saved.tangent = read_tangent(bytes.last(behind), tangent_numbers(point));
    bytes = bytes.first(bytes.size() - behind);
  }
  saved.state = point.state.read(bytes);
  if (!point.keeps_tangents) saved.tangent = {};
  return saved;
}

void restore_point(IntegrationPoint& point, SavedPoint saved) noexcept {
  point.state.restore(std::move(saved.state));
  point.committed_tangent = std::move(saved.tangent);
}

void load_each(PointSpan points, std::span<const std::span<const std::byte>> bytes,
               const NumberOf& number_of) {
  std::vector<SavedPoint> found;
  found.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    try {
      found.push_back(read_point(*points[k], bytes[k]));
    } catch (const Error& error) {
      throw Error(error.status, fmt::format("point {}: {}", number_of(k), error.what()));
    }
  }
  for (std::size_t k = 0; k < points.size(); ++k) restore_point(*points[k], std::move(found[k]));
}

std::size_t saved_size(PointSpan points) {
  std::size_t size = version_end + sizeof(std::uint64_t) + checksum_size;
  for (const IntegrationPoint* point : points) size += sizeof(std::uint64_t) + saved_size(*point);
  return size;
}

void save_points(PointSpan points, std::span<std::byte> bytes) {
  ByteWriter out(bytes);
  SavedKind written = saved_set;
  written.version = newest_set;
  out.begin(written);
  out.put(std::uint64_t{points.size()});
  for (const IntegrationPoint* point : points) {
    const std::size_t size = saved_size(*point);
    out.put(std::uint64_t{size});
    save_point(*point, out.skip(size));
  }
  out.end();
}

void load_points(PointSpan points, std::span<const std::byte> bytes) {
  if (points.size() == 1 && begin_as(bytes, saved_state)) {
    restore_point(*points[0], read_point(*points[0], bytes));
    return;
  }
  check_envelope(bytes, saved_set);
  ByteReader in(bytes.first(bytes.size() - checksum_size).subspan(version_end));
  if (in.left() < sizeof(std::uint64_t)) fail_truncated(0);
  if (const auto count = in.get<std::uint64_t>(); count != points.size())
    throw Error(GRAINLAW_BAD_ARGUMENT,
                fmt::format("saved points: {} points, expected {}", count, points.size()));
  std::vector<std::span<const std::byte>> parts;
  parts.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (in.left() < sizeof(std::uint64_t)) fail_truncated(k);
    const auto size = in.get<std::uint64_t>();
    if (size > in.left()) fail_truncated(k);
    parts.push_back(in.take(size));
  }
  if (in.left() != 0) throw Error(GRAINLAW_BAD_BYTES, "saved points: there is more behind them");
  load_each(points, parts, [](std::size_t k) { return k; });
}

}  // namespace grainlaw::core
