// Sequences of calls of the C ABI with any F: documented statuses, and what the header promises of them.
#include "support.hpp"

#include <grainlaw/grainlaw.hpp>

#include <fuzzer/FuzzedDataProvider.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace {

using grainlaw::Material;
using grainlaw::Points;
using grainlaw::State;
using Tensor = std::array<double, 4>;

const std::vector<Material>& materials() {
  static const std::vector<Material> all = [] {
    const std::string random =
        "dimension = 2\nthickness = 0.1\npacking = { generator = 'compaction', count = 12, radii = "
        "[4e-3, 6e-3], seed = 1, pressure = 1e5, friction = 0.2 }\ncontact = { " +
        fuzz::frictional + " }\n";
    std::vector<Material> made;
    for (const std::string& text :
         {random, random + "solver = { start = 'trial', contacts_lost = 'stress_free' }\n",
          random + "boundary = { type = 'frame-p' }\n", fuzz::lattice(fuzz::bonded),
          fuzz::lattice(fuzz::hertz), fuzz::lattice("law = 'compressive', young = 6e8"),
          fuzz::lattice(fuzz::frictional, fuzz::layer),
          fuzz::lattice(fuzz::frictional, "boundary = { type = 'frame-d' }\n")})
      made.push_back(Material::parse(text, "/"));
    return made;
  }();
  return all;
}

// Strains without an equilibrium within reach take nearly all of the time: an input has one that may be.
int large_strains_left = 0;

// Mostly near the committed one, else any doubles.
Tensor deformation(FuzzedDataProvider& input, const State& state) {
  Tensor F{};
  if (input.ConsumeProbability<float>() < 0.15F) {
    for (double& f : F) {
      const auto bits = input.ConsumeIntegral<std::uint64_t>();
      std::memcpy(&f, &bits, sizeof f);
    }
    return F;
  }
  constexpr std::array<double, 4> sizes{1e-6, 1e-4, 1e-2, 0.3};
  double size = input.PickValueInArray(sizes);
  if (size > 1e-3 && large_strains_left-- <= 0) size = 1e-4;
  const auto committed = state.measure(GRAINLAW_DEFORMATION_GRADIENT);
  for (std::size_t k = 0; k < 4; ++k)
    F[k] = committed[k] + size * input.ConsumeFloatingPointInRange<double>(-1, 1);
  return F;
}

bool finite(const double* values, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k)
    if (!std::isfinite(values[k])) return false;
  return true;
}

void evaluate(FuzzedDataProvider& input, State& state) {
  constexpr unsigned kinds[] = {0, GRAINLAW_WANT_TANGENT_EXACT, GRAINLAW_WANT_TANGENT_ELASTIC,
                                GRAINLAW_WANT_TANGENT_PERTURBED};
  const unsigned want = input.PickValueInArray(kinds);
  const Tensor F = deformation(input, state);
  const auto committed = state.save();
  constexpr double untouched = 4711;
  double P[4], A[16];
  std::fill(P, P + 4, untouched);
  std::fill(A, A + 16, untouched);
  grainlaw_report report = grainlaw_report_default();
  const auto status =
      grainlaw_evaluate(state.get(), F.data(), want, P, want != 0 ? A : nullptr, &report);
  EXPECT(state.get() != nullptr && state.save() == committed);
  EXPECT(std::memchr(report.message, '\0', sizeof report.message) != nullptr);
  EXPECT(status >= 0 || status == GRAINLAW_NOT_FINITE);
  if (status == GRAINLAW_OK) {
    EXPECT(finite(P, 4));
    EXPECT(want == 0 || finite(A, 16));
  } else {
    for (const double p : P) EXPECT(p == untouched);
    for (const double a : A) EXPECT(a == untouched);
    EXPECT(grainlaw_commit(state.get()) == GRAINLAW_NO_TRIAL);
  }
}

void batch(FuzzedDataProvider& input, std::vector<State>& states) {
  std::vector<grainlaw_state*> handles;
  std::vector<double> F;
  for (const State& state : states) {
    handles.push_back(state.get());
    const Tensor f = deformation(input, state);
    F.insert(F.end(), f.begin(), f.end());
  }
  std::vector<double> P(4 * states.size());
  std::vector<grainlaw_status> status(states.size());
  const auto whole = grainlaw_evaluate_batch(handles.size(), handles.data(), F.data(), 0, P.data(),
                                             nullptr, status.data(), nullptr, 1);
  bool all = true;
  for (std::size_t k = 0; k < states.size(); ++k) {
    all = all && status[k] == GRAINLAW_OK;
    EXPECT(status[k] != GRAINLAW_OK || finite(&P[4 * k], 4));
  }
  EXPECT(all == (whole == GRAINLAW_OK));
}

// A set, each call of which is of all points or of none.
void set_of_points(FuzzedDataProvider& input, const Material& material, const State& state) {
  Points set(material, input.ConsumeIntegralInRange<std::size_t>(0, 3));
  const std::size_t n = set.size();
  auto saved = set.save();
  bool trial = n == 0;  // of all points
  for (int call = 0; call < 5 && input.remaining_bytes() > 0; ++call) {
    const auto before = set.save();
    switch (input.ConsumeIntegralInRange<int>(0, 4)) {
      case 0: {
        if (!saved.empty() && input.ConsumeBool())
          saved[input.ConsumeIntegralInRange<std::size_t>(0, saved.size() - 1)] ^= std::byte{1};
        const auto status = grainlaw_points_load(set.get(), saved.data(), saved.size(), nullptr, 0);
        EXPECT(status == GRAINLAW_OK || status == GRAINLAW_BAD_BYTES);
        EXPECT(set.save() == (status == GRAINLAW_OK ? saved : before));
        if (status == GRAINLAW_OK) trial = n == 0;
        break;
      }
      case 1:
        saved = before;
        break;
      case 2:
        EXPECT(grainlaw_points_commit(set.get()) == (trial ? GRAINLAW_OK : GRAINLAW_NO_TRIAL));
        EXPECT(trial || set.save() == before);
        trial = n == 0;
        break;
      default: {
        std::vector<double> F, P(4 * n);
        for (std::size_t k = 0; k < n; ++k) {
          const Tensor next = deformation(input, state);
          F.insert(F.end(), next.begin(), next.end());
        }
        grainlaw_summary summary = grainlaw_summary_default();
        const auto status = grainlaw_points_evaluate(set.get(), F.data(), 0, P.data(), nullptr,
                                                     nullptr, nullptr, 1, &summary);
        EXPECT(set.save() == before);
        EXPECT((status == GRAINLAW_OK) == (summary.failed == 0 && summary.first_failed == -1));
        EXPECT(summary.first_failed < static_cast<long>(n));
        EXPECT(std::memchr(summary.message, '\0', sizeof summary.message) != nullptr);
        EXPECT(status != GRAINLAW_OK || finite(P.data(), P.size()));
        trial = status == GRAINLAW_OK;
      }
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider input(data, size);
  large_strains_left = 1;
  const Material& material =
      materials()[input.ConsumeIntegralInRange<std::size_t>(0, materials().size() - 1)];
  std::vector<State> states;
  states.emplace_back(material);
  std::vector<std::byte> saved = states[0].save();
  for (int call = 0; call < 8 && input.remaining_bytes() > 0; ++call) {
    State& state = states[input.ConsumeIntegralInRange<std::size_t>(0, states.size() - 1)];
    switch (input.ConsumeIntegralInRange<int>(0, 9)) {
      case 0:
        saved = state.save();
        break;
      case 1:
        state.load(saved);
        break;
      case 2:
        state.revert();
        break;
      case 3:
        if (states.size() < 3) states.push_back(State(state));
        break;
      case 4: {
        const int what = input.ConsumeIntegralInRange<int>(-1, 20);
        double values[4];
        std::size_t count = 4;
        const auto status = grainlaw_state_measure(state.get(), static_cast<grainlaw_measure>(what),
                                                   values, &count);
        EXPECT((status == GRAINLAW_OK) == (what >= 0 && what <= GRAINLAW_KINETIC_ENERGY));
        break;
      }
      case 5:
        batch(input, states);
        break;
      case 6: {
        const auto status = grainlaw_commit(state.get());
        EXPECT(status == GRAINLAW_OK || status == GRAINLAW_NO_TRIAL);
        break;
      }
      case 7:
        set_of_points(input, material, state);
        break;
      default:
        evaluate(input, state);
    }
  }
  return 0;
}
