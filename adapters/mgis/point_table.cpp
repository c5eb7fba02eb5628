#include "point_table.hpp"

#include "number_text.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>

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

grainlaw::Table& PointTable::table() {
  const grainlaw::Material& material = file_.material();
  const std::lock_guard lock(mutex_);
  if (!table_) {
    bytes_ = 2 * static_cast<double>(grainlaw::State(material).save().size());
    table_.emplace(material);
  }
  return *table_;
}

long long PointTable::create(double time_step) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t key = process_ + next_;
  if (time_steps_.empty() || time_steps_.back().second != time_step) {
    time_steps_.emplace_back(key, time_step);
  }
  ++next_;
  return static_cast<long long>(key);
}

double PointTable::first_time_step(std::uint64_t key) const {
  const std::lock_guard lock(mutex_);
  const auto after =
      std::upper_bound(time_steps_.begin(), time_steps_.end(), key,
                       [](std::uint64_t name, const auto& from) { return name < from.first; });
  return std::prev(after)->second;
}

long long PointTable::find(double name, double step, const Tensor2& F0) {
  if (!(name >= 1 && name < 0x1p53 && step >= 1 && step < 0x1p53)) unknown();
  const auto key = static_cast<std::uint64_t>(name);
  const auto element = static_cast<long long>(key);
  {
    const std::lock_guard lock(mutex_);
    ++calls_;
    if (calls_ - last_scan_ > patience * std::max<std::uint64_t>(last_calls_.size(), 64))
      free_idle();
    const bool ours = key > process_ && key < process_ + next_;
    const auto [at, is_new] = last_calls_.try_emplace(key, calls_);
    at->second = calls_;
    if (!is_new) return element;
    if (!ours || step != 1) {
      last_calls_.erase(at);
      unknown();
    }
  }
  try {
    Response unused;
    double token = 0;
    const Answer answer =
        evaluate(*table_, {element, 0, &token, nullptr, &F0, first_time_step(key)}, unused);
    if (answer.status == GRAINLAW_OK) return element;
    throw std::runtime_error(
        std::string("the host goes on from a deformation gradient at which the packing finds no "
                    "equilibrium: ") +
        grainlaw_status_text(answer.status));
  } catch (...) {
    const std::lock_guard lock(mutex_);
    last_calls_.erase(key);
    static_cast<void>(grainlaw_table_forget(table_->get(), element, 0));
    throw;
  }
}

void PointTable::free_idle() {
  last_scan_ = calls_;
  if (static_cast<double>(last_calls_.size()) * bytes_ <= budget_) return;
  const std::uint64_t limit = patience * last_calls_.size();
  std::erase_if(last_calls_, [&](const auto& entry) {
    const bool idle = calls_ - entry.second > limit;
    if (idle)
      static_cast<void>(
          grainlaw_table_forget(table_->get(), static_cast<long long>(entry.first), 0));
    return idle;
  });
}

std::size_t PointTable::size() const {
  const std::lock_guard lock(mutex_);
  return table_ ? table_->size() : 0;
}

}  // namespace grainlaw::adapters
