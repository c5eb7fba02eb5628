#include "equilibrium/tiny_increment.hpp"

#include "base/constants.hpp"
#include "increment/contact_state.hpp"

#include <algorithm>

namespace grainlaw::core {

namespace {

// Change of a contact's force by affine motion, over the force scale [-]; 0: no change but rounding.
template <int D>
double change_of_forces(const Request<D>& request, const Increment<D>& increment) {
  Tensor<D> change{};
  for (std::size_t k = 0; k < squared<D>; ++k) {
    change[k] = request.deformation[k] - request.from->deformation[k];
  }
  const double strain = largest_singular_value<D>(change);
  if (strain < tuned::least_strain) return 0;
  const double branch = increment.motion().mean_branch();
  return strain * branch * request.problem->law->largest_stiffness(branch / 2, branch / 2) /
         increment.scale().relative();
}

}  // namespace

template <int D>
bool solve_tiny(const Request<D>& request, double tolerance, double hand_over, long steps,
                Workspace<D>& w) {
  auto& increment = w.increment;
  const double change = tuned::share_of_increment * change_of_forces(request, increment);
  if (change == 0 || change >= tolerance || lost(increment)) return false;
  const double fine = std::max(change, least_tolerance(increment));
  const bool coarse = fine > tuned::worth_newton * hand_over;
  const bool relaxed = relax(increment, fine, coarse ? steps : tuned::steps_of_tiny_increment,
                             History::committed, w.relaxation, 0, false);
  if (relaxed && (coarse || increment.find_two_contact_spheres() < tolerance)) return true;
  return (!coarse && pseudo_transient_newton(increment, fine, tuned::bounded_first_factorisations,
                                             w.newton, &w.relaxation)) ||
         increment.residual_norm() < tolerance;
}

template bool solve_tiny(const Request<2>&, double, double, long, Workspace<2>&);
template bool solve_tiny(const Request<3>&, double, double, long, Workspace<3>&);

}  // namespace grainlaw::core
