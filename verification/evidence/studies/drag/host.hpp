// Hosts that lead one state: by strain, with what its path took and gave; and drained.
#pragma once

#include "evidence/studies/drag/setting.hpp"
#include "evidence/studies/statistics.hpp"

#include "app/cpu_time.hpp"
#include "point/driver.hpp"

#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

namespace verification::drag {

// Calls section(std::integral_constant<int, D>) with the dimension of the packing.
template <class Section>
auto in_dimension(int dimension, Section&& section) {
  return dimension == 2 ? section(std::integral_constant<int, 2>())
                        : section(std::integral_constant<int, 3>());
}

// Compression along the last axis at constant volume.
template <int D>
TensorOf<D> isochoric(double strain) {
  TensorOf<D> F = TensorOf<D>::Identity() * std::exp(strain / (D - 1));
  F(D - 1, D - 1) = std::exp(-strain);
  return F;
}

// Lateral less axial stress: above zero in compression [Pa].
template <int D>
double deviator(const TensorOf<D>& stress, const TensorOf<D>& deformation) {
  const TensorOf<D> sigma = cauchy_stress_of<D>(stress, deformation);
  const double axial = sigma(D - 1, D - 1);
  return (sigma.trace() - axial) / (D - 1) - axial;
}

template <int D>
struct Host {
  explicit Host(const Material& material) : state(material) {
    stress = evaluate_of<D>(state, deformation, 0).stress;
    state.revert();
  }

  // One increment, committed; in halves and so on where it fails, which last their share of `time`.
  bool lead(const TensorOf<D>& to, double time = 1, int halvings = 6) {
    check(grainlaw_state_set_time_step(state.get(), time), "telling the time step");
    const double start = cpu_seconds();
    const EvaluationOf<D> found = evaluate_of<D>(state, to, 0);
    milliseconds += 1e3 * (cpu_seconds() - start);
    ++evaluations;
    relaxation_steps += static_cast<double>(found.report.relaxation_steps);
    if (found.status == GRAINLAW_OK) {
      state.commit();
      deformation = to;
      stress = found.stress;
      report = found.report;
      unbalanced.push_back(report.unbalanced);
      return true;
    }
    if (halvings == 0) return false;
    ++cuts;
    const TensorOf<D> middle = 0.5 * (deformation + to);
    return lead(middle, time / 2, halvings - 1) && lead(to, time / 2, halvings - 1);
  }

  [[nodiscard]] double q() const { return deviator<D>(stress, deformation); }
  [[nodiscard]] double p() const { return -cauchy_stress_of<D>(stress, deformation).trace() / D; }

  State state;
  TensorOf<D> deformation = TensorOf<D>::Identity();
  TensorOf<D> stress;
  grainlaw_report report = grainlaw_report_default();
  std::vector<double> unbalanced;  // of every increment
  int evaluations = 0, cuts = 0;
  double relaxation_steps = 0, milliseconds = 0;
};

// A drained path, from its start to where it ended.
struct Drained {
  std::vector<double> strain{0}, stress{pressure};  // axial, compression above zero [Pa]
  std::vector<double> unbalanced;
  double dilation = 0;  // volumetric strain at the end
  int steps = 0;
  Effort effort;
  std::string failure;  // "": it reached its end

  [[nodiscard]] double mean_between(double low, double high) const {
    std::vector<double> values;
    for (std::size_t k = 0; k < strain.size(); ++k)
      if (strain[k] > low - 1e-9 && strain[k] < high + 1e-9) values.push_back(stress[k]);
    return average(values);
  }
};

template <int D>
Segment drained_to(double strain, int steps) {
  return D == 2 ? drained_segment(-strain, drained_pressure, steps)
                : triaxial_segment(-strain, drained_pressure, steps);
}

// To this axial strain; the observer sees each step before it is committed.
template <int D>
Drained drained(const Material& material, double strain, int steps, const PointOptions& options,
                const PointObserverOf<D>& observe = {}) {
  Drained path;
  try {
    PointDriverOf<D> driver(material, options);
    driver.run(drained_to<D>(strain, steps), [&](const PointStepOf<D>& step) {
      path.strain.push_back(step.record.axial_strain());
      path.stress.push_back(step.record.axial_stress());
      path.unbalanced.push_back(step.record.unbalanced);
      path.dilation = step.record.volumetric_strain();
      path.effort.add(step.record.effort);
      ++path.steps;
      if (observe) observe(step);
    });
  } catch (const ComputationError& error) {
    path.failure = error.what();
  }
  return path;
}

}  // namespace verification::drag
