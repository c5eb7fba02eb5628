#include "generate/compression.hpp"

#include "base/error.hpp"
#include "boundary/boundary_space.hpp"
#include "contact/contact_forces.hpp"
#include "equilibrium/strategy.hpp"
#include "generate/stretch_step.hpp"
#include "homogenise/stress.hpp"
#include "packing/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

// Compression with incomplete relaxations. Linear strain per step before and after the first load
// (a share of the final pressure). A passing state may not come to rest; the next step continues
// from it. Forces below a share of their final mean count as zero.
constexpr double loose_step = 5e-3;
constexpr double bearing_step = 5e-4;
constexpr double bearing_share = 1e-2;
// Void ratio below which every step is short from the start.
template <int D>
constexpr double dense_void_ratio = D == 2 ? 0.5 : 0.95;
constexpr double zero_force_share = 1e-3;
constexpr double passing_tolerance = 1e-2;
constexpr long passing_relaxation = 1000;
// Share of the target stresses from which equilibria are exact; residual of these over the mean
// contact force; relative accuracy of the final stresses.
constexpr double exact_from = 0.1;
constexpr double exact_tolerance = 1e-9;
// Residual at which Newton takes over, and its most factorisations; one costs a thousand relaxation
// steps of spheres.
template <int D>
constexpr double exact_relaxation = D == 2 ? 1e-4 : 1e-6;
template <int D>
constexpr long long_relaxation = D == 2 ? passing_relaxation : 5000;
template <int D>
constexpr int most_factorisations = D == 2 ? 50 : 10;
constexpr double stress_tolerance = 1e-7;
constexpr int most_steps = 600;

template <int D>
class Compression {
 public:
  Compression(const Packing& loose, const GeneratorOptions& options, const ContactLaw& law)
      : options_(options), packing_(loose), law_(law) {
    space_ = make_cell_space<D>(packing_);
    const double n = static_cast<double>(packing_.size());
    double radius = 0;
    for (const double r : packing_.radius) {
      solid_ += particle_size<D>(r);
      radius += r / n;
    }
    // Stress from p V = sum fn 2 R / D over D n contacts of branches 2 R.
    const double stress = options.void_ratio > 0
                              ? 1e-4 * law.stiffness(radius, radius) / depth<D>(packing_)
                              : options.pressure;
    bearing_pressure_ = bearing_share * stress;
    const double mean_force = stress * packing_.thickness * solid_ / (2 * n * radius);
    problem_ = {&packing_, &law_, &space_, zero_force_share * mean_force};
  }

  Configuration<D> run() {
    start_.deformation = identity<D>();
    start_.coordinates = packing_.position;
    if (law_.rotating()) append_zero_rotations<D>(packing_.size(), start_.coordinates);
    increment_.begin(problem_, start_, identity<D>());
    bool borne = void_ratio() < dense_void_ratio<D>;
    for (int step = 0; step < most_steps; ++step) {
      relax_to(passing_tolerance, passing_relaxation);
      const bool bears = pressure() > bearing_pressure_;
      borne = borne || bears;
      if (void_ratio() > options_.void_ratio * (1 + 1e-12) && (options_.void_ratio > 0 || !bears)) {
        shrink(borne ? bearing_step : loose_step);
        continue;
      }
      if (!bears)
        throw Error(GRAINLAW_BAD_PACKING,
                    fmt::format("generator: the {} bear no load at void_ratio = {}, expected a "
                                "lower one",
                                D == 2 ? "discs" : "spheres", options_.void_ratio));
      StretchStep<D> target = newton(elastic_tangent(increment_));
      if (target.misfit < exact_from) {
        const bool at_rest = come_to_rest();
        target = towards_target(at_rest);
        if (at_rest && target.misfit < stress_tolerance) return result();
      }
      stretch(target.change, bearing_step);
    }
    throw Error(
        GRAINLAW_NOT_CONVERGED,
        fmt::format("generator: no packing at rest was found; pressure {:.6g} Pa, void ratio "
                    "{:.6g}; try another seed",
                    pressure(), void_ratio()));
  }

 private:
  using Stretches = Vec<D>;

  [[nodiscard]] double void_ratio() const {
    double size = 1;
    for (std::size_t k = 0; k < D; ++k) size *= packing_.cell[(D + 1) * k];
    for (const double stretch : stretch_) size *= stretch;
    return size / solid_ - 1;
  }
  [[nodiscard]] double pressure() const {
    double sum = 0;
    for (std::size_t k = 0; k < D; ++k) sum += stress_[(D + 1) * k] / cofactor<D>(stretch_, k);
    return -1.0 / D * sum;
  }

  void stretch(const Stretches& change, double largest_strain) {
    double strain = 0;
    for (std::size_t k = 0; k < D; ++k) {
      strain = std::max(strain, std::abs(change[k] / stretch_[k]));
    }
    const double share = std::min(1.0, largest_strain / strain);
    Tensor<D> deformation{};
    for (std::size_t k = 0; k < D; ++k) {
      stretch_[k] += share * change[k];
      deformation[(D + 1) * k] = stretch_[k];
    }
    increment_.advance_history();
    increment_.deform(deformation);
  }

  // Shrinks by a linear strain, or to the target void ratio if that is less.
  void shrink(double strain) {
    if (options_.void_ratio > 0)
      strain = std::min(strain, 1 - edge_of<D>((1 + options_.void_ratio) / (1 + void_ratio())));
    Stretches change;
    for (std::size_t k = 0; k < D; ++k) change[k] = -strain * stretch_[k];
    stretch(change, strain);
  }

  bool relax_to(double tolerance, long most_relaxation) {
    const auto history = law_.tangential() ? History::advancing : History::committed;
    const bool done = relax(increment_, tolerance, most_relaxation, history, workspace_.relaxation);
    stress_ = piola_stress(increment_);
    return done;
  }

  // Finds the exact equilibrium, with sensitivities; returns false where none is in reach.
  bool come_to_rest() {
    relax_to(exact_relaxation<D>, long_relaxation<D>);
    workspace_.sensitivity.reset();
    const bool done = pseudo_transient_newton(increment_, exact_tolerance, most_factorisations<D>,
                                              workspace_.newton) &&
                      workspace_.sensitivity.solve(increment_, 1, 0, workspace_.newton.stiffness);
    stress_ = piola_stress(increment_);
    return done;
  }

  // Newton's step with the exact tangent where it is stable. Frictionless packings are often close
  // to a rearrangement; there the stiffer affine tangent is used.
  [[nodiscard]] StretchStep<D> towards_target(bool exact) const {
    StretchStep<D> target{};
    if (exact) target = newton(condensed_tangent(increment_, workspace_.sensitivity));
    if (!target.stable) target = newton(elastic_tangent(increment_));
    return target;
  }

  [[nodiscard]] StretchStep<D> newton(const Tensor4<D>& tangent) const {
    const bool keeps_volume = options_.void_ratio > 0;
    return step_of<D>({keeps_volume ? pressure() : options_.pressure, keeps_volume}, stretch_,
                      stress_, tangent);
  }

  // The final configuration, whose friction history starts here.
  [[nodiscard]] Configuration<D> result() {
    Configuration<D> at;
    increment_.advance_history();
    increment_.export_to(start_, at);
    at.stress = stress_;
    return at;
  }

  static Stretches unstretched() {
    Stretches ones;
    ones.fill(1);
    return ones;
  }

  const GeneratorOptions& options_;
  const Packing& packing_;  // the start configuration
  Configuration<D> start_;
  const ContactLaw& law_;
  BoundarySpace<D> space_;
  Problem<D> problem_;
  Workspace<D> workspace_;
  Increment<D>& increment_ = workspace_.increment;
  Stretches stretch_ = unstretched();  // stretches relative to the start
  Tensor<D> stress_{};                 // first Piola-Kirchhoff stress, same reference [Pa]
  double solid_ = 0;                   // area or volume of the particles [m2, m3]
  double bearing_pressure_ = 0;        // [Pa]
};

}  // namespace

template <int D>
Configuration<D> compress(const Packing& loose, const GeneratorOptions& options,
                          const ContactLaw& law) {
  return Compression<D>(loose, options, law).run();
}

template Configuration<2> compress(const Packing&, const GeneratorOptions&, const ContactLaw&);
template Configuration<3> compress(const Packing&, const GeneratorOptions&, const ContactLaw&);

}  // namespace grainlaw::core
