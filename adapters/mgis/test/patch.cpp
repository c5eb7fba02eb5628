// The common patch through the MGIS layout: P from the first Piola-Kirchhoff stress, A from dP/dF.
//
//   grainlaw_mgis_patch LIBRARY.so BEHAVIOUR HYPOTHESIS PATH.csv > mgis.csv
#include "mgis_host.hpp"

#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>
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
    std::ifstream path(arguments[4]);
    std::string line;
    std::getline(path, line);
    std::printf("P and A by rows\n");
    while (std::getline(path, line)) {
      std::replace(line.begin(), line.end(), ',', ' ');
      std::istringstream numbers(line);
      std::vector<double> given;
      for (double value; numbers >> value;) given.push_back(value);
      const std::size_t d = given.size() == 4 ? 2 : 3;
      if (given.size() != d * d) throw std::runtime_error("expected 4 or 9 components: " + line);
      std::array<double, 9> F{1, 0, 0, 0, 1, 0, 0, 0, 1};
      std::vector<std::size_t> places;  // of the rows' components in the order of MGIS
      for (std::size_t c = 0; c < d * d; ++c) {
        const std::size_t component = c / d * 3 + c % d;
        F[component] = given[c];
        places.push_back(static_cast<std::size_t>(
            std::find(tensor_order.begin(), tensor_order.end(), component) - tensor_order.begin()));
      }
      manager.set_F_in_space(0, F);
      if (manager.integrate(0) != 1) throw std::runtime_error(manager.message);
      const char* separator = "";
      for (const std::size_t a : places) {
        std::printf("%s%.17g", separator, manager.s1.forces[a]);
        separator = ",";
      }
      for (const std::size_t a : places)
        for (const std::size_t b : places) std::printf(",%.17g", manager.K[a * manager.tensor + b]);
      std::printf("\n");
      manager.update();
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
