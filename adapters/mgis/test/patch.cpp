// The common patch through the MGIS layout: P from the first Piola-Kirchhoff stress, A from dP/dF.
//
//   grainlaw_mgis_patch LIBRARY.so BEHAVIOUR HYPOTHESIS PATH.csv > mgis.csv
#include "mgis_host.hpp"

#include <cstdio>
#include <exception>
#include <fstream>
#include <string>

int main(int count, char** arguments) {
  using namespace grainlaw::test;
  if (count != 5) {
    std::fprintf(stderr, "usage: grainlaw_mgis_patch LIBRARY.so BEHAVIOUR HYPOTHESIS PATH.csv\n");
    return 2;
  }
  try {
    const BehaviourLibrary library(arguments[1]);
    Manager manager(library, arguments[2], arguments[3], 1, first_piola, dP_dF);
    constexpr std::array<std::size_t, 4> in_plane{0, 3, 4, 1};  // 11 12 21 22 among 11 22 33 12 21
    std::ifstream path(arguments[4]);
    std::string line;
    std::getline(path, line);
    std::printf("P11,P12,P21,P22");
    for (int a = 0; a < 16; ++a) {
      std::printf(",A%d%d%d%d", a / 8 + 1, a / 4 % 2 + 1, a / 2 % 2 + 1, a % 2 + 1);
    }
    std::printf("\n");
    while (std::getline(path, line)) {
      std::array<double, 4> F{};
      if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &F[0], &F[1], &F[2], &F[3]) != 4) return 1;
      manager.set_F(0, F);
      if (manager.integrate(0) != 1) throw std::runtime_error(manager.message);
      const char* separator = "";
      for (const std::size_t a : in_plane) {
        std::printf("%s%.17g", separator, manager.s1.forces[a]);
        separator = ",";
      }
      for (const std::size_t a : in_plane) {
        for (const std::size_t b : in_plane)
          std::printf(",%.17g", manager.K[a * manager.tensor + b]);
      }
      std::printf("\n");
      manager.update();
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
