#include "point_table.hpp"

#include "number_text.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <random>
#include <stdexcept>

namespace grainlaw::adapters {
namespace {

constexpr std::uint64_t serial_bits = 32;  // 20 more tell the process: 52 of a double's 53
constexpr std::uint64_t patience = 4;      // calls per state in memory
constexpr double mebibyte = 1024.0 * 1024.0;
constexpr double default_budget = 1024;  // MiB

double budget_from_environment() {
  const char* text = std::getenv("GRAINLAW_IDLE_MEMORY");
  if (text == nullptr) return default_budget * mebibyte;
  const std::optional<double> value = number(text);
  if (!value || !(*value >= 0)) {
    throw std::runtime_error(std::string("GRAINLAW_IDLE_MEMORY is '") + text +
                             "'; a number of MiB was expected");
  }
  return *value * mebibyte;
}

[[noreturn]] void unknown() {
  throw std::runtime_error(
      "the internal state variables GrainlawPoint and GrainlawStep name no state of this process: "
      "they come from another run, were changed, or the state was freed as idle "
      "(GRAINLAW_IDLE_MEMORY)");
}

}  // namespace

PointTable::PointTable(const char* name, const char* path, const void* in_library)
    : file_(name, path, in_library), budget_(budget_from_environment()) {
  std::random_device random;
  process_ = (1 + random() % ((1u << 20) - 1)) * (std::uint64_t{1} << serial_bits);
}

std::shared_ptr<TablePoint> PointTable::create(double time_step) {
  auto point = std::make_shared<TablePoint>(material());
  const std::lock_guard lock(mutex_);
  const std::uint64_t key = process_ + next_;
  if (time_steps_.empty() || time_steps_.back().second != time_step) {
    time_steps_.emplace_back(key, time_step);
  }
  ++next_;
  point->name = static_cast<double>(key);
  point->set_time_step(time_step);
  return point;
}

double PointTable::first_time_step(std::uint64_t key) const {
  const std::lock_guard lock(mutex_);
  const auto after =
      std::upper_bound(time_steps_.begin(), time_steps_.end(), key,
                       [](std::uint64_t name, const auto& from) { return name < from.first; });
  return std::prev(after)->second;
}

std::shared_ptr<TablePoint> PointTable::find(double name, double step) {
  if (!(name >= 1 && name < 0x1p53 && step >= 1 && step < 0x1p53)) unknown();
  const auto key = static_cast<std::uint64_t>(name);
  {
    const std::lock_guard lock(mutex_);
    ++calls_;
    if (calls_ - last_scan_ > patience * std::max<std::uint64_t>(points_.size(), 64)) free_idle();
    if (const auto found = points_.find(key); found != points_.end()) {
      found->second->last_call = calls_;
      return found->second;
    }
    const bool ours = key > process_ && key < process_ + next_;
    if (!ours || step != 1) unknown();
  }
  // Only its first increment was answered; the caller finds that again from F.
  auto point = std::make_shared<TablePoint>(material());
  point->name = name;
  point->set_time_step(first_time_step(key));
  add(point);
  return point;
}

void PointTable::add(const std::shared_ptr<TablePoint>& point) {
  const std::lock_guard lock(mutex_);
  if (bytes_ == 0) bytes_ = static_cast<double>(point->bytes());
  const auto key = static_cast<std::uint64_t>(point->name);
  point->last_call = ++calls_;
  new_.push_back(key);  // may stay alone, should there be no memory for the other
  points_.emplace(key, point);
  limit_new();
}

void PointTable::keep(const std::shared_ptr<TablePoint>& point) {
  const std::lock_guard lock(mutex_);
  if (point->kept) return;
  points_.try_emplace(static_cast<std::uint64_t>(point->name), point);  // freed since it was found
  point->kept = true;
  ++kept_;
}

void PointTable::limit_new() {
  const double most = std::max(static_cast<double>(kept_), budget_ / 4 / bytes_);
  while (static_cast<double>(points_.size() - kept_) > std::max(most, 1.0)) {
    const auto oldest = points_.find(new_.front());
    new_.pop_front();
    if (oldest != points_.end() && !oldest->second->kept) points_.erase(oldest);
  }
}

void PointTable::free_idle() {
  last_scan_ = calls_;
  const bool over_budget = static_cast<double>(kept_) * bytes_ > budget_;
  const std::uint64_t limit = patience * points_.size();
  for (auto at = points_.begin(); at != points_.end();) {
    const TablePoint& point = *at->second;
    const bool drop = calls_ - point.last_call > limit && (!point.kept || over_budget);
    if (drop && point.kept) --kept_;
    at = drop ? points_.erase(at) : std::next(at);
  }
  std::erase_if(new_, [this](std::uint64_t key) {
    const auto found = points_.find(key);
    return found == points_.end() || found->second->kept;
  });
}

std::size_t PointTable::size() const {
  const std::lock_guard lock(mutex_);
  return points_.size();
}

}  // namespace grainlaw::adapters
