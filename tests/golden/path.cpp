#include "path.hpp"

#include "../data.hpp"

#include <xxhash.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>

namespace grainlaw::golden {
namespace {

class Hash {
 public:
  Hash() { XXH3_64bits_reset(state_); }
  ~Hash() { XXH3_freeState(state_); }
  Hash(const Hash&) = delete;
  Hash& operator=(const Hash&) = delete;

  template <class Value>
  void add(std::span<const Value> values) {
    XXH3_64bits_update(state_, values.data(), values.size_bytes());
  }
  template <class Value>
  void add(const Value& value) {
    add(std::span<const Value>(&value, 1));
  }
  [[nodiscard]] std::string text() const {
    char digits[20];
    std::snprintf(digits, sizeof digits, "%016llx",
                  static_cast<unsigned long long>(XXH3_64bits_digest(state_)));
    return digits;
  }

 private:
  XXH3_state_t* state_ = XXH3_createState();
};

void add(Hash& hash, const grainlaw_report& report) {
  hash.add(report.residual);
  hash.add(report.step_ratio);
  hash.add(report.relaxation_steps);
  hash.add(report.servo_corrections);
  for (const int number : {report.factorisations, report.subincrements, report.contacts,
                           report.sliding, report.status_changes, report.tangent_exact,
                           report.history_advanced, report.broken_bonds}) {
    hash.add(number);
  }
  // Drag alone has them.
  if (report.unbalanced != 0) {
    hash.add(report.unbalanced);
    hash.add(report.viscous_work);
  }
  const std::string message = report.message;
  hash.add(std::span<const char>(message));
}

void add_measures(Hash& hash, const State& state) {
  const auto add = [&](grainlaw_measure what) {
    const std::vector<double> values = state.measure(what);
    // Inertia alone has it.
    if (what != GRAINLAW_KINETIC_ENERGY || values[0] != 0) hash.add(std::span(values));
  };
#define GRAINLAW_X(name, value, count, text) add(name);
  GRAINLAW_MEASURE_LIST(GRAINLAW_X)
#undef GRAINLAW_X
}

}  // namespace

Path::Path(std::string name, const std::string& toml, std::vector<Answer>& answers)
    : name_(std::move(name)),
      state_(Material::parse(toml, grainlaw::test::data_folder())),
      answers_(answers) {}

void Path::go_to(const Tensor& F, unsigned want) {
  try_out(F, want);
  if (found_) state_.commit();
  hash_state();
}

void Path::try_out(const Tensor& F, unsigned want) {
  Tensor P(F.size());
  std::vector<double> A(F.size() * F.size());
  const auto result = state_.evaluate(F, P, want, A);
  found_ = static_cast<bool>(result);
  Hash hash;
  hash.add(static_cast<int>(result.status));
  hash.add(std::span<const double>(P));
  hash.add(std::span<const double>(A));
  add(hash, result.report);
  add_measures(hash, state_);
  std::string text = hash.text() + " status " + std::to_string(result.status) + " P";
  for (const double component : P) {
    char number[32];
    std::snprintf(number, sizeof number, " %.10g", component);
    text += number;
  }
  record(text);
}

void Path::hash_state() {
  Hash hash;
  hash.add(std::span<const std::byte>(state_.save()));
  record(hash.text() + " committed");
}

void Path::record(const std::string& text) {
  char place[12];
  std::snprintf(place, sizeof place, "%2d ", step_++);
  answers_.push_back({name_, place + text});
}

}  // namespace grainlaw::golden
