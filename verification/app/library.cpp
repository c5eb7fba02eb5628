#include "app/library.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <string>
#include <system_error>

namespace verification {

void check(grainlaw_status status, const std::string& what) {
  if (status == GRAINLAW_OK) return;
  const int error = status == GRAINLAW_FILE_ERROR ? errno : 0;
  const std::string cause = error != 0 ? ": " + std::generic_category().message(error) : "";
  throw ComputationError(fmt::format("{}: {}{}", what, grainlaw_status_text(status), cause));
}

template <int D>
EvaluationOf<D> evaluate_of(State& state, const TensorOf<D>& deformation, unsigned want) {
  EvaluationOf<D> result;
  result.status = grainlaw_evaluate(state.get(), deformation.data(), want, result.stress.data(),
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

template <int D>
TensorOf<D> deformation_gradient(const grainlaw_state* state) {
  return TensorOf<D>::Map(measure(state, GRAINLAW_DEFORMATION_GRADIENT).data());
}

template <int D>
TangentOf<D> cauchy_tangent(const TensorOf<D>& stress, const TangentOf<D>& tangent,
                            const TensorOf<D>& deformation) {
  const double jacobian = deformation.determinant();
  const TensorOf<D> inverse = deformation.inverse();
  const TensorOf<D> sigma = cauchy_stress_of<D>(stress, deformation);
  TangentOf<D> result;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j)
      for (int k = 0; k < D; ++k)
        for (int l = 0; l < D; ++l) {
          double sum = j == k ? stress(i, l) : 0;
          for (int m = 0; m < D; ++m) sum += tangent(D * i + m, D * k + l) * deformation(j, m);
          result(D * i + j, D * k + l) = sum / jacobian - sigma(i, j) * inverse(l, k);
        }
  return result;
}

template EvaluationOf<2> evaluate_of<2>(State&, const TensorOf<2>&, unsigned);
template EvaluationOf<3> evaluate_of<3>(State&, const TensorOf<3>&, unsigned);
template TensorOf<2> deformation_gradient<2>(const grainlaw_state*);
template TensorOf<3> deformation_gradient<3>(const grainlaw_state*);
template TangentOf<2> cauchy_tangent<2>(const TensorOf<2>&, const TangentOf<2>&,
                                        const TensorOf<2>&);
template TangentOf<3> cauchy_tangent<3>(const TensorOf<3>&, const TangentOf<3>&,
                                        const TensorOf<3>&);

}  // namespace verification
