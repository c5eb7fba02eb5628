// Leads one point along a path of deformation gradients, commits each, and prints P and the exact
// tangent: what every host has to find for the same path. Each row takes a time of 1.
//
//   grainlaw_patch MATERIAL.toml PATH.csv > reference.csv
#include <grainlaw/grainlaw.hpp>

#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

// The numbers of a line, with commas between them.
std::vector<double> numbers(std::string line, std::size_t count) {
  for (char& letter : line)
    if (letter == ',') letter = ' ';
  std::istringstream text(line);
  std::vector<double> found;
  for (double value; text >> value;) found.push_back(value);
  if (found.size() != count)
    throw std::runtime_error("expected " + std::to_string(count) + " components of F: " + line);
  return found;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "usage: grainlaw_patch MATERIAL.toml PATH.csv\n");
    return 2;
  }
  try {
    std::ifstream path(arguments[2]);
    std::string line;
    if (!std::getline(path, line)) throw std::runtime_error("the path cannot be read");
    const grainlaw::Material material = grainlaw::Material::load(arguments[1]);
    const auto d = static_cast<std::size_t>(material.dimension());
    grainlaw::State point(material);
    point.set_time_step(1);
    for (std::size_t a = 0; a < d * d; ++a)
      std::printf("%sP%zu%zu", a == 0 ? "" : ",", a / d + 1, a % d + 1);
    for (std::size_t a = 0; a < d * d * d * d; ++a)
      std::printf(",A%zu%zu%zu%zu", a / (d * d * d) + 1, a / (d * d) % d + 1, a / d % d + 1,
                  a % d + 1);
    std::printf("\n");
    std::vector<double> P(d * d), A(d * d * d * d);
    while (std::getline(path, line)) {
      if (!point.evaluate(numbers(line, d * d), P, GRAINLAW_WANT_TANGENT_EXACT, A)) {
        throw std::runtime_error("an increment of the path found no equilibrium");
      }
      point.commit();
      for (std::size_t k = 0; k < P.size(); ++k) std::printf("%s%.17g", k == 0 ? "" : ",", P[k]);
      for (const double a : A) std::printf(",%.17g", a);
      std::printf("\n");
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
