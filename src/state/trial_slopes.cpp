#include "state/trial_slopes.hpp"

#include "base/capacity.hpp"

#include <algorithm>

namespace grainlaw::core {

namespace {

template <int D>
inline constexpr std::size_t lanes_of_change = D == 2 ? 4 : 6;

}  // namespace

template <int D>
std::size_t number_of_slopes(const Problem<D>& problem) {
  return lanes_of_change<D> * problem.node_unknowns();
}

template <int D>
void keep_slopes(const Problem<D>& problem, std::span<const ByDeformation<D>> motion,
                 std::vector<float>& slopes) {
  const std::size_t nodes = problem.nodes();
  const auto components = static_cast<std::size_t>(problem.components());
  slopes.resize(lanes_of_change<D> * motion.size());
  auto at = slopes.begin();
  for (std::size_t lane = 0; lane < lanes_of_change<D>; ++lane) {
    for (std::size_t k = 0; k < components; ++k) {
      for (std::size_t q = 0; q < nodes; ++q)
        *at++ = static_cast<float>(motion[q * components + k].lane[lane]);
    }
  }
}

template <int D>
void follow_slopes(std::span<const float> slopes, std::vector<double>& step, Request<D>& request) {
  if (slopes.empty()) return;
  Tensor<D> change;
  for (std::size_t k = 0; k < squared<D>; ++k)
    change[k] = request.deformation[k] - request.guess_deformation[k];
  const ByDeformation<D> factors = in_directions<D>(change, request.from->deformation);
  const std::size_t size = slopes.size() / lanes_of_change<D>;
  resize_with_capacity(step, size);
  std::fill(step.begin(), step.end(), 0.0);
  for (std::size_t lane = 0; lane < lanes_of_change<D>; ++lane) {
    const auto column = slopes.subspan(lane * size, size);
    for (std::size_t k = 0; k < size; ++k) step[k] += factors.lane[lane] * column[k];
  }
  request.guess_step = step;
}

template std::size_t number_of_slopes(const Problem<2>&);
template std::size_t number_of_slopes(const Problem<3>&);
template void keep_slopes(const Problem<2>&, std::span<const ByDeformation<2>>,
                          std::vector<float>&);
template void keep_slopes(const Problem<3>&, std::span<const ByDeformation<3>>,
                          std::vector<float>&);
template void follow_slopes(std::span<const float>, std::vector<double>&, Request<2>&);
template void follow_slopes(std::span<const float>, std::vector<double>&, Request<3>&);

}  // namespace grainlaw::core
