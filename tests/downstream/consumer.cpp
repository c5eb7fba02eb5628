// A host in C++20: load a material, compress it by 0.1 %, commit, print the stress.
#include <grainlaw/grainlaw.hpp>

#include <array>
#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const auto material = grainlaw::Material::load(argv[1]);
    grainlaw::State state(material);
    const std::array<double, 4> F{1, 0, 0, 0.999};
    std::array<double, 4> P{};
    std::array<double, 16> A{};
    if (const auto result = state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A); !result) {
      std::fprintf(stderr, "%s: retry with %g of the step\n", grainlaw_status_text(result.status),
                   result.report.step_ratio);
      return 1;
    }
    state.commit();
    const double void_ratio = state.measure(GRAINLAW_VOID_RATIO)[0];
    std::printf("grainlaw %s: P11 = %.6g Pa, P22 = %.6g Pa, dP22/dF22 = %.6g Pa, e = %.4f [-]\n",
                grainlaw_version(), P[0], P[3], A[15], void_ratio);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
