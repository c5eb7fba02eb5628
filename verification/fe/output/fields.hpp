// Fields at integration points, for ParaView, pictures and tables.
#pragma once

#include "fe/model.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace verification {

// An integration point after a load step.
struct PointView {
  const grainlaw_state* state;
  const double* deformation;  // F row by row [-]
  const double* stress;       // P row by row [Pa]
  const grainlaw_report& report;
};
PointView point_view(const PointField& points, std::size_t point);

// A quantity at a point: a number, or the components of a tensor row by row.
struct Field {
  std::string_view name;
  std::string_view unit;
  std::string_view label;  // for pictures
  int components;
  void (*value)(const PointView& point, double* out);

  // In pictures stresses are in kPa.
  [[nodiscard]] bool pascal() const { return unit == "Pa"; }
  [[nodiscard]] double picture_factor() const { return pascal() ? 1e-3 : 1; }
  [[nodiscard]] std::string_view picture_unit() const { return pascal() ? "kPa" : unit; }
};

// All fields in a dimension. Tension is positive in stress and strain, compression in mean_stress.
// In the plane strains, p and q are those of Guo & Zhao (2014), eqs. 6, 7, 10, 12, 13. In space q =
// sqrt(3/2 s:s) and the deviatoric strain sqrt(2/3 e:e) with the deviators s and e.
const std::vector<Field>& fields(int dimension);
// Field of this name. Throws InputError with all names.
const Field& field(std::string_view name, int dimension);
// "name[unit]" of every component.
std::vector<std::string> columns(const Field& field);

// values[point * components + component] of all points.
std::vector<double> values(const Field& field, const PointField& points);

// Position of a point, in the reference and with these displacements [m].
Position reference_position(const Mesh& mesh, const PointField& points, std::size_t point);
Position current_position(const Mesh& mesh, const PointField& points, std::size_t point,
                          const Eigen::VectorXd& displacement);

}  // namespace verification
