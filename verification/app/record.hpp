// Record of an integration point after a step.
#pragma once

#include "app/library.hpp"

#include <string>
#include <vector>

namespace verification {

// Work of library and driver in one step.
struct Effort {
  int iterations = 0;          // linear solves of the driver's Newton [-]
  int evaluations = 0;         // calls of the library per point [-]
  int cuts = 0;                // times the step was cut [-]
  int loose = 0;               // parts accepted out of balance [-]
  int crossed = 0;             // jumps of P before a balanced part [-]
  long relaxation_steps = 0;   // [-]
  long servo_corrections = 0;  // [-]
  int factorisations = 0;      // [-]
  int subincrements = 0;       // largest of all evaluations [-]
  int history_advanced = 0;    // accepted evaluations that advanced the friction history [-]

  void add(const grainlaw_report& report);
  void add(const Effort& other);
};

// Numbers of a record, in the plane and in space.
struct RecordNumbers {
  int step = 0;
  double void_ratio = 0;
  double coordination = 0;
  double coordination_no_rattlers = 0;
  double fabric_intensity = 0;
  double anisotropy = 0;
  double mean_overlap = 0;       // [m]
  double mean_rotation = 0;      // [rad]; spheres: length of the mean rotation vector
  double elastic_energy = 0;     // [J]
  double dissipated_energy = 0;  // [J]
  double external_work = 0;      // sum over the steps of V0 P:dF, trapezoid rule [J]
  double contacts = 0;
  double sliding = 0;
  double status_changes = 0;
  double broken_bonds = 0;       // since F = I
  double escaped_particles = 0;  // inner particles outside the polygon of a frame
  double unbalanced = 0;         // with drag: the largest on a particle / mean contact force [-]
  Effort effort;
};

template <int D>
struct RecordOf : RecordNumbers {
  using Tensor = TensorOf<D>;
  Tensor deformation = Tensor::Identity();  // F [-]
  Tensor stress = Tensor::Zero();           // P [Pa], tension positive
  Tensor cauchy = Tensor::Zero();           // sigma [Pa], tension positive
  Tensor fabric = Tensor::Zero();           // spheres only [-]

  // Axial axis: 2 of discs, 3 of spheres. Axial strain 1 - F22 or 1 - F33, compression positive;
  // volumetric strain det F - 1, dilation positive.
  [[nodiscard]] double axial_strain() const { return 1 - deformation(D - 1, D - 1); }
  [[nodiscard]] double volumetric_strain() const { return deformation.determinant() - 1; }
  // Axial and lateral stress, compression positive [Pa]. Lateral: -sigma11, for spheres the mean of
  // -sigma11 and -sigma22.
  [[nodiscard]] double axial_stress() const { return -cauchy(D - 1, D - 1); }
  [[nodiscard]] double lateral_stress() const {
    return D == 2 ? -cauchy(0, 0) : -0.5 * (cauchy(0, 0) + cauchy(1, 1));
  }
  [[nodiscard]] double stress_ratio() const { return axial_stress() / lateral_stress(); }
  // p = -tr sigma / D, compression positive [Pa]. q is axial less lateral stress, below 0 in
  // extension [Pa].
  [[nodiscard]] double mean_pressure() const { return -cauchy.trace() / D; }
  [[nodiscard]] double deviatoric_stress() const { return axial_stress() - lateral_stress(); }
};
using Record = RecordOf<2>;

// Measures of a state (trial, or committed without a trial) at F with P. Sliding contacts and
// status changes come from the report.
template <int D>
RecordOf<D> make_record(const grainlaw_state* state, const TensorOf<D>& deformation,
                        const TensorOf<D>& stress, const grainlaw_report& report);

// Mean over points of these weights, except for step, effort and numbers derived from F; of
// `unbalanced` the largest.
template <int D>
RecordOf<D> mean(const std::vector<RecordOf<D>>& records, std::vector<double> weight);

// With drag the last one is `unbalanced`.
template <int D = 2>
std::vector<std::string> record_columns(bool drag = false);
template <int D>
std::vector<double> record_values(const RecordOf<D>& record, bool drag = false);

}  // namespace verification
