// A host whose evaluations are counted: `counted_host MATERIAL.toml INCREMENTS none|exact|elastic`.
// Compresses at constant volume, 0.1 % an increment, and prints the bytes of the saved state.
#include <grainlaw/grainlaw.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

int main(int count, char** arguments) try {
  if (count != 4) return 2;
  const auto material = grainlaw::Material::load(arguments[1]);
  const int increments = std::atoi(arguments[2]);
  const std::string tangent = arguments[3];
  const unsigned want = tangent == "exact"     ? GRAINLAW_WANT_TANGENT_EXACT
                        : tangent == "elastic" ? GRAINLAW_WANT_TANGENT_ELASTIC
                                               : 0U;
  const auto dim = static_cast<std::size_t>(material.dimension());
  std::vector<double> F(dim * dim), P(dim * dim), A(want == 0 ? 0 : dim * dim * dim * dim);
  grainlaw::State state(material);
  for (int k = 1; k <= increments; ++k) {
    const double axial = 1 - 1e-3 * k;
    for (std::size_t m = 0; m < dim; ++m)
      F[(dim + 1) * m] =
          m + 1 == dim ? axial : std::pow(axial, -1 / (static_cast<double>(dim) - 1));
    if (!state.evaluate(F, P, want, A)) return 1;
    state.commit();
  }
  std::printf("%zu\n", state.save().size());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
