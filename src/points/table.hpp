// Points of a host that never says commit, found by element and point. Tokens tell where a call
// starts: see grainlaw_table_evaluate.
#pragma once

#include "points/points.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace grainlaw::core {

// Element and point.
using PointKey = std::pair<std::int64_t, std::int64_t>;

std::string text_of(const PointKey& key);

struct TablePoint {
  explicit TablePoint(AnyState state) : point{std::move(state)} {}

  IntegrationPoint point;
  std::uint64_t increments = 0;  // committed
  std::vector<double> trial;     // F of the trial; empty: none
  bool known = false;            // has given an answer, or comes from bytes
  std::mutex in_use{};           // held by the call that works on the point
};

// What a call tells of its start; each may be null.
struct TableStart {
  const double* token;
  const double* F0;
};

class PointTable {
 public:
  explicit PointTable(AnyMaterial material) : material_(std::move(material)) {}

  [[nodiscard]] const AnyMaterial& material() const { return material_; }
  [[nodiscard]] int dimension() const { return material_.index() == 0 ? 2 : 3; }
  [[nodiscard]] std::size_t size() const;

  // The point of a key, made at F = I where it is new. Throws bad_alloc.
  std::shared_ptr<TablePoint> find_or_make(const PointKey& key);
  // Throws Error (BAD_ARGUMENT) for an unknown key.
  [[nodiscard]] std::shared_ptr<TablePoint> find(const PointKey& key) const;
  void forget(const PointKey& key);

  // Bytes of all points in the order of their keys, and back: all or none, as load_points() throws.
  [[nodiscard]] std::size_t saved_size() const;
  void save(std::span<std::byte> bytes) const;
  void load(std::span<const std::byte> bytes);

 private:
  using Points = std::map<PointKey, std::shared_ptr<TablePoint>>;

  [[noreturn]] static void fail_unknown(const PointKey& key);

  AnyMaterial material_;
  mutable std::mutex mutex_;
  Points points_;
};

// Evaluates the point at F without a tangent; it does not throw.
using EvaluateAt =
    std::function<grainlaw_status(IntegrationPoint& point, const double* F, std::string& why)>;

// Brings a point to the committed state that the call starts from: drops the trial, or commits it.
// An accepted answer that is not the trial is found again by `evaluate`. Throws Error
// (BAD_ARGUMENT, or what `evaluate` met) where no known state is meant.
void start_from(TablePoint& at, const TableStart& start, const EvaluateAt& evaluate);

}  // namespace grainlaw::core
