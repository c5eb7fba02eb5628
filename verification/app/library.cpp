#include "app/library.hpp"

#include <fmt/format.h>

namespace verification {

void check(grainlaw_status status, const std::string& what) {
  if (status != GRAINLAW_OK)
    throw ComputationError(fmt::format("{}: {}", what, grainlaw_status_text(status)));
}

State make_state(const Material& material) {
  grainlaw_state* state = nullptr;
  check(grainlaw_state_create(material.get(), &state), "creating an integration point");
  return State(state);
}

State clone(const grainlaw_state* state) {
  grainlaw_state* copy = nullptr;
  check(grainlaw_state_clone(state, &copy), "copying an integration point");
  return State(copy);
}

Points make_points(const Material& material, std::size_t count) {
  grainlaw_points* points = nullptr;
  check(grainlaw_points_create(material.get(), count, &points), "creating integration points");
  return Points(points);
}

Evaluation evaluate(grainlaw_state* state, const Tensor& deformation, unsigned want) {
  Evaluation result;
  result.status = grainlaw_evaluate(state, deformation.data(), want, result.stress.data(),
                                    want != 0 ? result.tangent.data() : nullptr, &result.report);
  if (result.status < 0) check(result.status, "evaluating an integration point");
  return result;
}

unsigned tangent_bit(const std::string& name) {
  if (name == "exact") return GRAINLAW_WANT_TANGENT_EXACT;
  if (name == "elastic") return GRAINLAW_WANT_TANGENT_ELASTIC;
  if (name == "perturbed") return GRAINLAW_WANT_TANGENT_PERTURBED;
  throw InputError(
      fmt::format("tangent: found \"{}\", expected \"exact\", \"elastic\" or \"perturbed\"", name));
}

std::vector<double> measure(const grainlaw_state* state, grainlaw_measure what) {
  std::size_t count = 0;
  check(grainlaw_state_measure(state, what, nullptr, &count), "sizing a measure");
  std::vector<double> value(count);
  if (count > 0) check(grainlaw_state_measure(state, what, value.data(), &count), "measuring");
  return value;
}

double measure_scalar(const grainlaw_state* state, grainlaw_measure what) {
  const std::vector<double> value = measure(state, what);
  return value.empty() ? 0 : value.front();
}

Tensor deformation_of(const grainlaw_state* state) {
  const std::vector<double> f = measure(state, GRAINLAW_DEFORMATION_GRADIENT);
  return to_tensor({f[0], f[1], f[2], f[3]});
}

Tensor cauchy_stress(const Tensor& stress, const Tensor& deformation) {
  return stress * deformation.transpose() / deformation.determinant();
}

Tangent cauchy_tangent(const Tensor& stress, const Tangent& tangent, const Tensor& deformation) {
  const double jacobian = deformation.determinant();
  const Tensor inverse = deformation.inverse();
  const Tensor sigma = cauchy_stress(stress, deformation);
  Tangent result;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 2; ++k)
        for (int l = 0; l < 2; ++l) {
          double sum = j == k ? stress(i, l) : 0;
          for (int m = 0; m < 2; ++m) sum += tangent(2 * i + m, 2 * k + l) * deformation(j, m);
          result(2 * i + j, 2 * k + l) = sum / jacobian - sigma(i, j) * inverse(l, k);
        }
  return result;
}

}  // namespace verification
