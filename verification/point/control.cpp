#include "point/control.hpp"

#include <algorithm>
#include <cmath>

namespace verification {

template <int D>
Conditions<D> conditions_of(const Segment& segment) {
  Conditions<D> conditions{};
  for (std::size_t k = 0; k < conditions.size(); ++k) conditions[k] = segment.target[k];
  return conditions;
}

template <int D>
Controlled<D> controlled(const Conditions<D>& conditions, const TensorOf<D>& deformation,
                         const EvaluationOf<D>& evaluation) {
  const ComponentsOf<D> piola = components_of<D>(evaluation.stress);
  const ComponentsOf<D> sigma =
      components_of<D>(cauchy_stress_of<D>(evaluation.stress, deformation));
  const TangentOf<D> spatial =
      cauchy_tangent<D>(evaluation.stress, evaluation.tangent, deformation);
  Controlled<D> result{components_of<D>(deformation), TangentOf<D>::Identity()};
  for (int k = 0; k < D * D; ++k) {
    const Target& target = conditions[static_cast<std::size_t>(k)];
    switch (target.control) {
      case Control::deformation:
        break;
      case Control::piola:
        result.value(k) = piola(k);
        result.derivative.row(k) = evaluation.tangent.row(k);
        break;
      case Control::cauchy:
        result.value(k) = sigma(k);
        result.derivative.row(k) = spatial.row(k);
        break;
      case Control::mean:
        result.value(k) = 0;
        result.derivative.row(k).setZero();
        for (int i = 0; i < D; ++i) {
          result.value(k) += sigma((D + 1) * i) / D;
          result.derivative.row(k) += spatial.row((D + 1) * i) / D;
        }
        break;
      case Control::difference:
        result.value(k) = sigma(k) - sigma(target.other) -
                          target.share * (sigma(D * D - 1) - sigma(target.other));
        result.derivative.row(k) =
            spatial.row(k) - spatial.row(target.other) -
            target.share * (spatial.row(D * D - 1) - spatial.row(target.other));
        break;
    }
  }
  return result;
}

template <int D>
TensorOf<D> with_volume(TensorOf<D> deformation, const std::array<bool, 3>& follows,
                        double determinant) {
  constexpr double rounding = 4e-16;
  constexpr int most = 100;
  const auto count = static_cast<double>(std::count(follows.begin(), follows.end(), true));
  for (int k = 0; k < most; ++k) {
    const double ratio = determinant / deformation.determinant();
    if (!(ratio > 0) || std::abs(ratio - 1) <= rounding) break;
    const double factor = std::pow(ratio, 1 / count);
    for (int i = 0; i < D; ++i)
      if (follows[static_cast<std::size_t>(i)]) deformation(i, i) *= factor;
  }
  return deformation;
}

template <int D>
void follow_volume(TangentOf<D>& derivative, const TensorOf<D>& deformation,
                   const std::array<bool, 3>& follows) {
  const TensorOf<D> of_volume = deformation.inverse().transpose();
  int first = -1;
  for (int i = 0; i < D; ++i) {
    if (!follows[static_cast<std::size_t>(i)]) continue;
    const int k = (D + 1) * i;
    derivative.row(k).setZero();
    if (first < 0) {
      first = i;
      derivative.row(k) = components_of<D>(of_volume).transpose();
    } else {
      derivative(k, k) = 1 / deformation(i, i);
      derivative(k, (D + 1) * first) = -1 / deformation(first, first);
    }
  }
}

template Conditions<2> conditions_of<2>(const Segment&);
template Conditions<3> conditions_of<3>(const Segment&);
template Controlled<2> controlled<2>(const Conditions<2>&, const TensorOf<2>&,
                                     const EvaluationOf<2>&);
template Controlled<3> controlled<3>(const Conditions<3>&, const TensorOf<3>&,
                                     const EvaluationOf<3>&);
template TensorOf<2> with_volume<2>(TensorOf<2>, const std::array<bool, 3>&, double);
template TensorOf<3> with_volume<3>(TensorOf<3>, const std::array<bool, 3>&, double);
template void follow_volume<2>(TangentOf<2>&, const TensorOf<2>&, const std::array<bool, 3>&);
template void follow_volume<3>(TangentOf<3>&, const TensorOf<3>&, const std::array<bool, 3>&);

}  // namespace verification
