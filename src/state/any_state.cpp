#include "state/any_state.hpp"

#include "base/error.hpp"
#include "material/packing_file.hpp"
#include "state/lists.hpp"
#include "state/output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

template <int D>
void check(const Tensor<D>& F) {
  for (std::size_t i = 0; i < D; ++i)
    for (std::size_t j = 0; j < D; ++j)
      if (const double entry = F[i * D + j]; !std::isfinite(entry))
        throw Error(GRAINLAW_NOT_FINITE, fmt::format("F{}{} is {}", i + 1, j + 1, entry));
  const double det = determinant<D>(F);
  if (!std::isfinite(det)) throw Error(GRAINLAW_STEP_TOO_LARGE, "det F overflows");
  if (det <= 0) throw Error(GRAINLAW_INVERTED, fmt::format("det F = {:.6g}, expected > 0", det));
}

template <int D>
std::variant<State<2>, State<3>> state_of(const std::shared_ptr<const Material<D>>& material) {
  return State<D>(material);
}

}  // namespace

AnyMaterial make_any_material(MaterialDescription description) {
  if (description.packing.dimension == 3) return make_material<3>(std::move(description));
  return make_material<2>(std::move(description));
}

AnyState::AnyState(const AnyMaterial& material)
    : state_(std::visit([](const auto& one) { return state_of(one); }, material)) {}

AnyState::AnyState(const AnyState& other) = default;
AnyState::AnyState(AnyState&& other) noexcept = default;
AnyState& AnyState::operator=(AnyState&& other) noexcept = default;
AnyState::~AnyState() = default;

bool AnyState::shares_material(const AnyState& other) const {
  const auto material = [](const auto& state) -> const void* { return &state.material(); };
  return std::visit(material, state_) == std::visit(material, other.state_);
}

void AnyState::check_deformation(const double* F) const {
  std::visit([&]<int D>(const State<D>& state) { check<D>(state.effective(F)); }, state_);
}

grainlaw_status AnyState::evaluate(const double* F, TangentKind kind, double* P, double* A,
                                   grainlaw_report& report) {
  return std::visit([&](auto& state) { return state.evaluate(F, kind, P, A, report); }, state_);
}

void AnyState::set_time_step(double step) {
  std::visit([=](auto& state) { state.set_time_step(step); }, state_);
}

double AnyState::time_step() const {
  return std::visit([](const auto& state) { return state.time_step(); }, state_);
}

bool AnyState::commit() {
  return std::visit([](auto& state) { return state.commit(); }, state_);
}

void AnyState::revert() {
  std::visit([](auto& state) { state.revert(); }, state_);
}

bool AnyState::has_trial() const {
  return std::visit([](const auto& state) { return state.has_trial(); }, state_);
}

std::vector<double> AnyState::committed_deformation() const {
  return std::visit(
      [](const auto& state) {
        const auto F = state.deformation_of_host(state.committed());
        return std::vector<double>(F.begin(), F.end());
      },
      state_);
}

void AnyState::committed_stress(double* P) const {
  std::visit(
      [=](const auto& state) { std::ranges::copy(state.stress_of_host(state.committed()), P); },
      state_);
}

double AnyState::unforeseen(std::span<const double> tangent) const {
  return std::visit([&](const auto& state) { return state.unforeseen(tangent); }, state_);
}

std::size_t AnyState::saved_size() const {
  return std::visit(
      [](const auto& state) {
        return grainlaw::core::saved_size(state.material(), state.committed(), state.reference());
      },
      state_);
}

void AnyState::save(std::span<std::byte> bytes) const {
  std::visit(
      [&](const auto& state) {
        save_configuration(state.material(), state.committed(), bytes, state.time_step(),
                           state.reference());
      },
      state_);
}

SavedState AnyState::read(std::span<const std::byte> bytes) const {
  return std::visit(
      [&](const auto& state) -> SavedState { return load_configuration(state.material(), bytes); },
      state_);
}

void AnyState::restore(SavedState saved) noexcept {
  std::visit(
      [&]<int D>(State<D>& state) { state.restore(std::get<SavedStateOf<D>>(std::move(saved))); },
      state_);
}

std::size_t AnyState::saved_trial_size(bool evaluated) const {
  return std::visit([=](const auto& state) { return state.saved_trial_size(evaluated); }, state_);
}

void AnyState::save_trial(bool evaluated, std::span<std::byte> bytes) const {
  std::visit([&](const auto& state) { state.save_trial(evaluated, bytes); }, state_);
}

SavedTrial AnyState::read_trial(std::span<const std::byte> bytes) const {
  return std::visit([&](const auto& state) -> SavedTrial { return state.read_trial(bytes); },
                    state_);
}

void AnyState::restore(SavedTrial saved) noexcept {
  std::visit(
      [&]<int D>(State<D>& state) { state.restore(std::get<SavedTrialOf<D>>(std::move(saved))); },
      state_);
}

void AnyState::measure(grainlaw_measure what, double* value) const {
  std::visit([&](const auto& state) { state.measure(what, value); }, state_);
}

std::vector<grainlaw_particle> AnyState::particles() const {
  return std::visit(
      [](const auto& state) { return list_particles(state.material(), state.current()); }, state_);
}

std::vector<grainlaw_contact> AnyState::contacts() const {
  return std::visit(
      [](const auto& state) { return list_contacts(state.material(), state.current()); }, state_);
}

void AnyState::write_force_chains(const std::string& path) const {
  std::visit(
      [&](const auto& state) {
        grainlaw::core::write_force_chains(path, state.material(), state.current());
      },
      state_);
}

void AnyState::write_packing(const std::string& prefix) const {
  std::visit(
      [&](const auto& state) {
        grainlaw::core::write_packing(prefix, as_packing(state.material(), state.current()));
      },
      state_);
}

}  // namespace grainlaw::core
