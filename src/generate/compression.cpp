#include "generate/compression.hpp"

#include "base/error.hpp"
#include "boundary/boundary_space.hpp"
#include "contact/contact_forces.hpp"
#include "equilibrium/strategy.hpp"
#include "homogenise/stress.hpp"
#include "packing/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace grainlaw::core {

namespace {

// Compression with incomplete relaxations: linear strain per step, of discs that never bore load
// and of those that did (a share of the final pressure); not every passing state comes to rest, the
// next step moves on from it. Forces count as faded at a share of what their mean will be.
constexpr double loose_step = 5e-3;
constexpr double bearing_step = 5e-4;
constexpr double bearing_share = 1e-2;
constexpr double dense_void_ratio = 0.5;  // below it every step is short from the start
constexpr double faded_force = 1e-3;
constexpr double passing_tolerance = 1e-2;
constexpr long passing_relaxation = 1000;
// Within this share of the target stresses equilibria are exact, to a residual relative to the mean
// contact force. Relative accuracy of the stresses at the end.
constexpr double exact_from = 0.1;
constexpr double exact_relaxation = 1e-4;
constexpr double exact_tolerance = 1e-9;
constexpr int most_factorisations = 50;
constexpr double stress_tolerance = 1e-7;
constexpr int most_steps = 600;

using Stretches = std::array<double, 2>;

class Compression {
 public:
  Compression(const Packing& loose, const GeneratorOptions& options, const ContactLaw& law)
      : options_(options), packing_(loose), law_(law) {
    space_ = make_cell_space<2>(packing_);
    const double n = static_cast<double>(packing_.size());
    double radius = 0;
    for (const double r : packing_.radius) {
      solid_ += particle_size<2>(r);
      radius += r / n;
    }
    // With 2 n contacts of branches 2 R: p V = sum fn 2 R / 2.
    const double stress = options.void_ratio > 0
                              ? 1e-4 * law.stiffness(radius, radius) / packing_.thickness
                              : options.pressure;
    bearing_pressure_ = bearing_share * stress;
    const double mean_force = stress * packing_.thickness * solid_ / (2 * n * radius);
    problem_ = {&packing_, &law_, &space_, faded_force * mean_force};
  }

  Configuration<2> run() {
    start_.deformation = {1, 0, 0, 1};
    start_.coordinates = packing_.position;
    if (law_.rotating()) start_.coordinates.resize(Dimension<2>::unknowns * packing_.size(), 0.0);
    increment_.begin(problem_, start_, {1, 0, 0, 1});
    bool borne = void_ratio() < dense_void_ratio;
    for (int step = 0; step < most_steps; ++step) {
      relax_to(passing_tolerance);
      const bool bears = pressure() > bearing_pressure_;
      borne = borne || bears;
      if (void_ratio() > options_.void_ratio * (1 + 1e-12) && (options_.void_ratio > 0 || !bears)) {
        shrink(borne ? bearing_step : loose_step);
        continue;
      }
      if (!bears)
        throw Error(GRAINLAW_BAD_PACKING,
                    fmt::format("generator: the discs bear no load at void_ratio = {}, expected a "
                                "lower one",
                                options_.void_ratio));
      Target target = newton(elastic_tangent(increment_));
      if (target.misfit < exact_from) {
        const bool at_rest = come_to_rest();
        target = towards_target(at_rest);
        if (at_rest && target.misfit < stress_tolerance) return result();
      }
      stretch(target.step, bearing_step);
    }
    throw Error(
        GRAINLAW_NOT_CONVERGED,
        fmt::format("generator: no packing at rest was found; pressure {:.6g} Pa, void ratio "
                    "{:.6g}; try another seed",
                    pressure(), void_ratio()));
  }

 private:
  [[nodiscard]] double void_ratio() const {
    return packing_.cell[0] * packing_.cell[3] * stretch_[0] * stretch_[1] / solid_ - 1;
  }
  [[nodiscard]] double pressure() const {
    return -0.5 * (stress_[0] / stretch_[1] + stress_[3] / stretch_[0]);
  }

  void stretch(Stretches change, double largest_strain) {
    const double strain =
        std::max(std::abs(change[0] / stretch_[0]), std::abs(change[1] / stretch_[1]));
    const double share = std::min(1.0, largest_strain / strain);
    stretch_ = {stretch_[0] + share * change[0], stretch_[1] + share * change[1]};
    increment_.advance_history();
    increment_.deform({stretch_[0], 0, 0, stretch_[1]});
  }

  // By a linear strain, or to the target void ratio if that is less.
  void shrink(double strain) {
    if (options_.void_ratio > 0)
      strain = std::min(strain, 1 - std::sqrt((1 + options_.void_ratio) / (1 + void_ratio())));
    stretch({-strain * stretch_[0], -strain * stretch_[1]}, strain);
  }

  bool relax_to(double tolerance) {
    const auto history = law_.tangential() ? History::advancing : History::committed;
    const bool done =
        relax(increment_, tolerance, passing_relaxation, history, workspace_.relaxation);
    stress_ = piola_stress(increment_);
    return done;
  }

  // The exact equilibrium, with sensitivities; false when it is out of reach from here.
  bool come_to_rest() {
    relax_to(exact_relaxation);
    workspace_.sensitivity.reset();
    const bool done = pseudo_transient_newton(increment_, exact_tolerance, most_factorisations,
                                              workspace_.newton) &&
                      workspace_.sensitivity.solve(increment_, 1, 0, workspace_.newton.stiffness);
    stress_ = piola_stress(increment_);
    return done;
  }

  struct Target {
    double misfit;  // of the stresses, relative to the pressure [-]
    bool stable;    // the step leads downhill in enthalpy
    Stretches step;
  };

  // Newton's step with the exact tangent where that is stable; frictionless packings are often
  // close to a rearrangement, and then the stiffer affine tangent leads on.
  [[nodiscard]] Target towards_target(bool exact) const {
    Target target{};
    if (exact) target = newton(condensed_tangent(increment_, workspace_.sensitivity));
    if (!target.stable) target = newton(elastic_tangent(increment_));
    return target;
  }

  [[nodiscard]] Target newton(const std::array<double, 16>& tangent) const {
    const auto [a, b] = stretch_;
    const auto& p = stress_;
    // dP11 and dP22 by the two stretches.
    const double c11 = tangent[0];
    const double c12 = tangent[3];
    const double c21 = tangent[12];
    const double c22 = tangent[15];
    if (options_.void_ratio > 0) {
      // Area fixed: a = s exp(q), b = s exp(-q); Cauchy stresses P11 / b and P22 / a equal.
      const double difference = p[0] / b - p[3] / a;
      const double slope = (c11 * a - c12 * b + p[0]) / b - (c21 * a - c22 * b - p[3]) / a;
      const double q = -difference / slope;
      return {
          std::abs(difference) / pressure(), slope > 0, {a * std::expm1(q), b * std::expm1(-q)}};
    }
    const double target = options_.pressure;
    const double r1 = p[0] + target * b;
    const double r2 = p[3] + target * a;
    const double k12 = c12 + target;
    const double k21 = c21 + target;
    const double det = c11 * c22 - k12 * k21;
    const bool stable = c11 > 0 && 4 * c11 * c22 > (k12 + k21) * (k12 + k21);
    return {std::max(std::abs(r1) / b, std::abs(r2) / a) / target,
            stable,
            {-(c22 * r1 - k12 * r2) / det, -(c11 * r2 - k21 * r1) / det}};
  }

  // The increment's friction history starts anew here.
  [[nodiscard]] Configuration<2> result() {
    Configuration<2> at;
    increment_.advance_history();
    increment_.export_to(start_, at);
    at.stress = stress_;
    return at;
  }

  const GeneratorOptions& options_;
  const Packing& packing_;  // the start configuration
  Configuration<2> start_;
  const ContactLaw& law_;
  BoundarySpace<2> space_;
  Problem<2> problem_;
  Workspace<2> workspace_;
  Increment<2>& increment_ = workspace_.increment;
  Stretches stretch_ = {1, 1};      // of the start configuration
  std::array<double, 4> stress_{};  // first Piola-Kirchhoff against it [Pa]
  double solid_ = 0;                // area of the discs [m2]
  double bearing_pressure_ = 0;     // [Pa]
};

}  // namespace

Configuration<2> compress(const Packing& loose, const GeneratorOptions& options,
                          const ContactLaw& law) {
  return Compression(loose, options, law).run();
}

}  // namespace grainlaw::core
