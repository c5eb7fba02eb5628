// Layout, little-endian:
//   "GRAINTAB"  u32 version  u64 points
//   of each point: i64 element  i64 point  u64 increments  f64 time step  u64 size  its state
//   u64 XXH3 of everything before
#include "points/table.hpp"

#include "base/error.hpp"
#include "base/saved_bytes.hpp"
#include "points/serialise_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw::core {

namespace {

constexpr SavedKind saved_table{"saved table", {'G', 'R', 'A', 'I', 'N', 'T', 'A', 'B'}, 1};
constexpr std::size_t head_size = 5 * sizeof(std::uint64_t);  // of a point, before its state

// Largest difference in F of a host that computes it twice, and of two states that are not one [-].
constexpr double rounding = 1e-12;
constexpr double same_place = 1e-9;

[[noreturn]] void refuse(const std::string& text) { throw Error(GRAINLAW_BAD_ARGUMENT, text); }

double distance(std::span<const double> F, const double* other) {
  double largest = 0;
  for (const double component : F) {
    const double difference = std::abs(component - *other++);
    if (std::isnan(difference)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, difference);
  }
  return largest;
}

void commit(TablePoint& at) {
  at.point.commit();
  ++at.increments;
  at.trial.clear();
}

void accept(TablePoint& at, const double* F0, const EvaluateAt& evaluate) {
  if (!at.known)
    refuse(
        "no answer of this point is known from which the host could go on; an analysis cannot be "
        "restarted without its states");
  const bool is_trial = !at.trial.empty() && (F0 == nullptr || distance(at.trial, F0) <= rounding);
  if (!is_trial) {
    if (F0 == nullptr) refuse("the last answer failed: the host cannot have gone on from it");
    std::string why;
    at.trial.clear();
    if (const auto status = evaluate(at.point, F0, why); status != GRAINLAW_OK)
      throw Error(status < 0 ? status : GRAINLAW_BAD_ARGUMENT,
                  "the host goes on from a deformation gradient at which the packing finds no "
                  "equilibrium: " +
                      why);
  }
  commit(at);
}

}  // namespace

std::string text_of(const PointKey& key) {
  return fmt::format("element {}, point {}", key.first, key.second);
}

void start_from(TablePoint& at, const TableStart& start, const EvaluateAt& evaluate) {
  const std::vector<double> committed = at.point.state.committed_deformation();
  const double off = start.F0 == nullptr ? 0 : distance(committed, start.F0);
  if (start.token == nullptr) {
    if (off <= rounding) return;
    return accept(at, start.F0, evaluate);
  }
  const auto own = static_cast<double>(at.increments);
  if (*start.token == own + 1) return accept(at, start.F0, evaluate);
  if (*start.token != own)
    refuse(
        fmt::format("the token is {:.16g}, but the point has gone through {} increments: only "
                    "the last one can be retried",
                    *start.token, at.increments));
  if (!(off <= same_place))
    refuse(
        "the deformation gradient at the start of the step is not that of the point's state: two "
        "points hold the same token, or gradients were not kept with it");
}

std::size_t PointTable::size() const {
  const std::lock_guard lock(mutex_);
  return points_.size();
}

std::shared_ptr<TablePoint> PointTable::find_or_make(const PointKey& key) {
  const std::lock_guard lock(mutex_);
  if (const auto found = points_.find(key); found != points_.end()) return found->second;
  return points_.emplace(key, std::make_shared<TablePoint>(AnyState(material_))).first->second;
}

std::shared_ptr<TablePoint> PointTable::find(const PointKey& key) const {
  const std::lock_guard lock(mutex_);
  const auto found = points_.find(key);
  if (found == points_.end()) fail_unknown(key);
  return found->second;
}

void PointTable::forget(const PointKey& key) {
  const std::lock_guard lock(mutex_);
  if (points_.erase(key) == 0) fail_unknown(key);
}

void PointTable::fail_unknown(const PointKey& key) { refuse(text_of(key) + ": not in this table"); }

std::size_t PointTable::saved_size() const {
  const std::lock_guard lock(mutex_);
  std::size_t size = version_end + sizeof(std::uint64_t) + checksum_size;
  for (const auto& [key, at] : points_) size += head_size + at->point.state.saved_size();
  return size;
}

void PointTable::save(std::span<std::byte> bytes) const {
  const std::lock_guard lock(mutex_);
  ByteWriter out(bytes);
  out.begin(saved_table);
  out.put(std::uint64_t{points_.size()});
  for (const auto& [key, at] : points_) {
    const std::size_t size = at->point.state.saved_size();
    out.put(key.first);
    out.put(key.second);
    out.put(at->increments);
    out.put(at->point.state.time_step());
    out.put(std::uint64_t{size});
    at->point.state.save(out.skip(size));
  }
  out.end();
}

void PointTable::load(std::span<const std::byte> bytes) {
  check_envelope(bytes, saved_table);
  const auto require = [](bool condition) {
    if (!condition) throw Error(GRAINLAW_BAD_BYTES, "saved table: truncated or too long");
  };
  ByteReader in(bytes.first(bytes.size() - checksum_size).subspan(version_end));
  require(in.left() >= sizeof(std::uint64_t));
  const auto count = in.get<std::uint64_t>();
  Points found;
  for (std::uint64_t k = 0; k < count; ++k) {
    require(in.left() >= head_size);
    const auto element = in.get<std::int64_t>();
    const PointKey key{element, in.get<std::int64_t>()};
    auto at = std::make_shared<TablePoint>(AnyState(material_));
    at->increments = in.get<std::uint64_t>();
    const double time_step = in.get_finite();
    const auto size = in.get<std::uint64_t>();
    require(size <= in.left());
    try {
      restore_point(at->point, read_point(at->point, in.take(size)));
    } catch (const Error& error) {
      throw Error(error.status, text_of(key) + ": " + error.what());
    }
    at->point.state.set_time_step(time_step);
    at->known = true;
    found.emplace(key, std::move(at));
  }
  require(in.left() == 0 && found.size() == count);
  const std::lock_guard lock(mutex_);
  points_.swap(found);
}

}  // namespace grainlaw::core
