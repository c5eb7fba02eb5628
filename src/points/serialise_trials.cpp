// Layout, little-endian:
//   "GRAINTRY"  u32 version  f64 seconds  i64 cost;
//   u64 size  the bytes of the trial;
//   u32 kind of its tangent; where it has one: A [dim^4] doubles;
//   u64 XXH3 of everything before.
#include "points/serialise_trials.hpp"

#include "base/error.hpp"
#include "base/saved_bytes.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace grainlaw::core {

namespace {

constexpr SavedKind saved_trial{"saved trial", {'G', 'R', 'A', 'I', 'N', 'T', 'R', 'Y'}, 1};
constexpr std::size_t cost_size = sizeof(double) + sizeof(std::int64_t);
constexpr std::size_t fixed_size =
    version_end + cost_size + sizeof(std::uint64_t) + sizeof(std::uint32_t) + checksum_size;

struct SavedTrialPoint {
  double seconds = 0;
  long cost = 0;
  SavedTrial trial;
  KeptTangent tangent;
};

TangentKind kept_kind(const IntegrationPoint& point, bool evaluated) {
  return evaluated && point.state.has_trial() ? point.trial_tangent.kind : TangentKind::none;
}

std::size_t tangent_numbers(const IntegrationPoint& point) {
  const auto square = static_cast<std::size_t>(point.state.dimension() * point.state.dimension());
  return square * square;
}

[[noreturn]] void fail(const char* found) {
  throw Error(GRAINLAW_BAD_BYTES, fmt::format("saved trial: {}", found));
}

SavedTrialPoint read_trial(const IntegrationPoint& point, std::span<const std::byte> bytes) {
  check_envelope(bytes, saved_trial);
  if (bytes.size() < fixed_size) fail("truncated");
  ByteReader in(bytes.first(bytes.size() - checksum_size).subspan(version_end));
  SavedTrialPoint saved;
  saved.seconds = in.get_finite();
  saved.cost = static_cast<long>(in.get<std::int64_t>());
  const auto size = in.get<std::uint64_t>();
  if (size > in.left() - sizeof(std::uint32_t)) fail("its length does not fit its content");
  saved.trial = point.state.read_trial(in.take(size));
  const auto kind = in.get<std::uint32_t>();
  if (kind > static_cast<std::uint32_t>(TangentKind::perturbed)) fail("a tangent of no known kind");
  saved.tangent.kind = static_cast<TangentKind>(kind);
  const std::size_t numbers = kind == 0 ? 0 : tangent_numbers(point);
  if (in.left() != sizeof(double) * numbers) fail("its length does not fit its content");
  saved.tangent.values.resize(numbers);
  for (double& value : saved.tangent.values) value = in.get_finite();
  return saved;
}

}  // namespace

std::size_t saved_trial_size(const IntegrationPoint& point, bool evaluated) {
  const bool has_tangent = kept_kind(point, evaluated) != TangentKind::none;
  return fixed_size + point.state.saved_trial_size(evaluated) +
         (has_tangent ? sizeof(double) * tangent_numbers(point) : 0);
}

void save_trial(const IntegrationPoint& point, bool evaluated, std::span<std::byte> bytes) {
  ByteWriter out(bytes);
  out.begin(saved_trial);
  out.put(point.seconds);
  out.put(static_cast<std::int64_t>(point.cost));
  const std::size_t size = point.state.saved_trial_size(evaluated);
  out.put(std::uint64_t{size});
  point.state.save_trial(evaluated, out.skip(size));
  const TangentKind kind = kept_kind(point, evaluated);
  out.put(static_cast<std::uint32_t>(kind));
  if (kind != TangentKind::none)
    for (const double value : point.trial_tangent.values) out.put(value);
  out.end();
}

void load_trials(PointSpan points, std::span<const std::span<const std::byte>> bytes,
                 const NumberOf& number_of) {
  std::vector<SavedTrialPoint> found;
  found.reserve(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    try {
      found.push_back(read_trial(*points[k], bytes[k]));
    } catch (const Error& error) {
      throw Error(error.status, fmt::format("point {}: {}", number_of(k), error.what()));
    }
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k]->seconds = found[k].seconds;
    points[k]->cost = found[k].cost;
    points[k]->state.restore(std::move(found[k].trial));
    points[k]->trial_tangent = std::move(found[k].tangent);
  }
}

}  // namespace grainlaw::core
