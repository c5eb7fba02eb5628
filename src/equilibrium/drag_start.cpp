#include "equilibrium/drag_start.hpp"

#include "base/constants.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

// Drag so many times as stiff as a contact lets nothing move against the rest: P is within 1e-6 of its limit.
// Beyond, distances drown in rounding.
constexpr double largest_drag = 1e4;

}  // namespace

template <int D>
DragStart<D> drag_start(const Request<D>& request, int k, int parts) {
  const Viscosity& viscosity = request.options->viscosity;
  const Tensor<D>& before = request.from->deformation;
  const auto at = [&](int part) {
    return between<D>(before, request.deformation, static_cast<double>(part) / parts);
  };
  const double shortest = 1 / std::sqrt(viscosity.time * largest_drag);
  const double time = std::max(request.duration / parts, shortest);
  const double mass = viscosity.inertia / time;
  const double drag = 1 - viscosity.inertia;
  const double inertia = mass / (mass + drag);
  DragStart<D> how;
  how.rate = (mass + drag) / (viscosity.time * time);
  how.stretch = product<D>(at(k), inverse<D>(k == 1 ? before : at(k - 1)));
  for (std::size_t i = 0; i < D; ++i) how.stretch[(D + 1) * i] -= 1;
  if (k > 1) {
    how.follow = inertia;
    return how;
  }
  const Tensor<D>& last = request.from->move_stretch;
  double along = 0, square = 0;
  for (std::size_t i = 0; i < squared<D>; ++i) {
    along += how.stretch[i] * last[i];
    square += last[i] * last[i];
  }
  if (!(square > tuned::least_followed_strain * tuned::least_followed_strain)) return how;
  const double ratio = along / square;
  how.follow = inertia * std::clamp(ratio, 0.0, tuned::largest_follow);
  if (ratio < 0 || ratio >= tuned::largest_follow) return how;
  for (std::size_t i = 0; i < squared<D>; ++i) {
    how.follow_by_stretch[i] = inertia * last[i] / square;
  }
  return how;
}

template DragStart<2> drag_start(const Request<2>&, int, int);
template DragStart<3> drag_start(const Request<3>&, int, int);

}  // namespace grainlaw::core
