// A host that has what the library has inside: Eigen, fmt and toml++ of its own, compiled with its own
// flags, and an amd_2 that is not the ordering. Prints the answer to the last bit.
// With PLAIN: the same host without them.
#include <grainlaw/grainlaw.h>

#include <cstdio>
#include <cstdlib>

#ifndef PLAIN
#define TOML_HEADER_ONLY 0
#define TOML_IMPLEMENTATION
#include <fmt/format.h>
#include <toml++/toml.h>

#include <Eigen/Dense>

extern "C" void amd_2() { std::abort(); }
extern "C" void amd_defaults() { std::abort(); }

// Something of each, at the sizes and types that the library uses too.
static bool own_libraries_work() {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(20, 20);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(20);
  const bool lu = (a * a.lu().solve(b) - b).norm() < 1e-8;
  const bool qr = (a * a.colPivHouseholderQr().solve(b) - b).norm() < 1e-8;
  const bool text = fmt::format("{:.17g} {}", 0.1, "m") == "0.10000000000000001 m";
  const auto table = toml::parse("x = [1, 2.5]\n[y]\nz = 'w'");
  return lu && qr && text && table["x"][1].value_or(0.) == 2.5;
}
#else
static bool own_libraries_work() { return true; }
#endif

int main(int argc, char** argv) {
  if (argc != 2 || !own_libraries_work()) return 2;
  const double F[4] = {1, 0.0005, 0, 0.999};
  double P[4], A[16];
  char message[512];
  grainlaw_material* material = nullptr;
  grainlaw_state* state = nullptr;
  grainlaw_report report = grainlaw_report_default();
  grainlaw_status status = grainlaw_material_load(argv[1], &material, message, sizeof message);
  if (status == GRAINLAW_OK) status = grainlaw_state_create(material, &state);
  if (status == GRAINLAW_OK)
    status = grainlaw_evaluate(state, F, GRAINLAW_WANT_TANGENT_EXACT, P, A, &report);
  if (status != GRAINLAW_OK) {
    std::fprintf(stderr, "%s: %s%s\n", grainlaw_status_text(status), message, report.message);
    return 1;
  }
  for (const double p : P) std::printf("%a\n", p);
  for (const double a : A) std::printf("%a\n", a);
  grainlaw_state_destroy(state);
  grainlaw_material_destroy(material);
}
