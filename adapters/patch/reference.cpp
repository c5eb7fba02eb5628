// Leads one point along a path of deformation gradients, commits each, and prints P and the exact
// tangent: what every host has to find for the same path. Each row takes a time of 1.
//
//   grainlaw_patch MATERIAL.toml PATH.csv > reference.csv
#include <grainlaw/grainlaw.hpp>

#include <array>
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: grainlaw_patch MATERIAL.toml PATH.csv\n");
    return 2;
  }
  try {
    std::ifstream path(arguments[2]);
    std::string line;
    if (!std::getline(path, line)) throw std::runtime_error("the path cannot be read");
    grainlaw::State point(grainlaw::Material::load(arguments[1]));
    point.set_time_step(1);
    std::printf("P11,P12,P21,P22");
    for (int a = 0; a < 16; ++a) {
      std::printf(",A%d%d%d%d", a / 8 + 1, a / 4 % 2 + 1, a / 2 % 2 + 1, a % 2 + 1);
    }
    std::printf("\n");
    while (std::getline(path, line)) {
      std::array<double, 4> F{};
      if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &F[0], &F[1], &F[2], &F[3]) != 4) {
        throw std::runtime_error("a line of the path is not F11,F12,F21,F22: " + line);
      }
      std::array<double, 4> P{};
      std::array<double, 16> A{};
      if (!point.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A)) {
        throw std::runtime_error("an increment of the path found no equilibrium");
      }
      point.commit();
      for (std::size_t k = 0; k < 4; ++k) std::printf("%s%.17g", k == 0 ? "" : ",", P[k]);
      for (const double a : A) std::printf(",%.17g", a);
      std::printf("\n");
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
