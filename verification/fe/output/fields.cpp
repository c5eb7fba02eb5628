#include "fe/output/fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

template <int D>
TensorOf<D> cauchy(const PointView& point) {
  return cauchy_stress_of<D>(TensorOf<D>::Map(point.stress), TensorOf<D>::Map(point.deformation));
}

template <int D>
TensorOf<D> small_strain(const PointView& point) {
  const TensorOf<D> deformation = TensorOf<D>::Map(point.deformation);
  return 0.5 * (deformation + deformation.transpose()) - TensorOf<D>::Identity();
}

template <int D>
TensorOf<D> deviator(const TensorOf<D>& tensor) {
  return tensor - tensor.trace() / D * TensorOf<D>::Identity();
}

template <int D>
double deviatoric_stress(const PointView& point) {
  return std::sqrt(D == 2 ? 0.5 : 1.5) * deviator<D>(cauchy<D>(point)).norm();
}

template <grainlaw_measure what>
void size_of_measure(const PointView& point, double* out) {
  const std::vector<double> value = measure(point.state, what);
  out[0] = value.size() == 3 ? std::hypot(value[0], value[1], value[2])
                             : measure_scalar(point.state, what);
}

template <int D>
void put(const TensorOf<D>& tensor, double* out) {
  std::copy(tensor.data(), tensor.data() + D * D, out);
}

template <int D>
std::vector<Field> make_fields() {
  constexpr int tensor = D * D;
  return {
      {"stress", "Pa", "Cauchy stress", tensor,
       [](const PointView& p, double* out) { put<D>(cauchy<D>(p), out); }},
      {"mean_stress", "Pa", "mean stress p, compression +", 1,
       [](const PointView& p, double* out) { out[0] = -cauchy<D>(p).trace() / D; }},
      {"deviatoric_stress", "Pa", "deviatoric stress q", 1,
       [](const PointView& p, double* out) { out[0] = deviatoric_stress<D>(p); }},
      {"stress_ratio", "-",
       D == 2 ? "stress ratio |s11 - s22| / |s11 + s22|" : "stress ratio q / |p|", 1,
       [](const PointView& p, double* out) {
         const TensorOf<D> stress = cauchy<D>(p);
         const double sum = std::abs(stress.trace());
         const double difference =
             D == 2 ? std::abs(stress(0, 0) - stress(1, 1)) : 3 * deviatoric_stress<D>(p);
         out[0] = sum > 0 ? difference / sum : 0;
       }},
      {"strain", "-", "strain", tensor,
       [](const PointView& p, double* out) { put<D>(small_strain<D>(p), out); }},
      {"volumetric_strain", "-", "volumetric strain, dilation +", 1,
       [](const PointView& p, double* out) {
         out[0] = TensorOf<D>::Map(p.deformation).determinant() - 1;
       }},
      {"deviatoric_strain", "-", "deviatoric strain", 1,
       [](const PointView& p, double* out) {
         out[0] = std::sqrt(D == 2 ? 2.0 : 2.0 / 3) * deviator<D>(small_strain<D>(p)).norm();
       }},
      {"deformation", "-", "deformation gradient", tensor,
       [](const PointView& p, double* out) { put<D>(TensorOf<D>::Map(p.deformation), out); }},
      {"void_ratio", "-", "void ratio", 1, size_of_measure<GRAINLAW_VOID_RATIO>},
      {"coordination", "-", "coordination number", 1, size_of_measure<GRAINLAW_COORDINATION>},
      {"anisotropy", "-", "anisotropy", 1, size_of_measure<GRAINLAW_ANISOTROPY>},
      {"fabric_intensity", "-", "fabric intensity", 1, size_of_measure<GRAINLAW_FABRIC_INTENSITY>},
      {"fabric", "-", "fabric", tensor,
       [](const PointView& p, double* out) {
         const std::vector<double> fabric = measure(p.state, GRAINLAW_FABRIC);
         std::copy(fabric.begin(), fabric.end(), out);
       }},
      {"rotation", "rad", "mean particle rotation", 1, size_of_measure<GRAINLAW_MEAN_ROTATION>},
      {"contacts", "-", "contacts", 1, size_of_measure<GRAINLAW_CONTACTS>},
      // 0: direct; 1: the friction history was advanced; 2: no contact is left.
      {"status", "-", "status", 1, [](const PointView& p, double* out) {
         const bool loose = measure_scalar(p.state, GRAINLAW_CONTACTS) == 0;
         out[0] = loose ? 2 : p.report.history_advanced != 0 ? 1 : 0;
       }}};
}

}  // namespace

PointView point_view(const PointField& points, std::size_t point) {
  return {points.state(point), points.deformation(point).data(), points.stress(point).data(),
          points.report(point)};
}

const std::vector<Field>& fields(int dimension) {
  static const std::vector<Field> plane = make_fields<2>(), solid = make_fields<3>();
  return dimension == 2 ? plane : solid;
}

const Field& field(std::string_view name, int dimension) {
  for (const Field& candidate : fields(dimension))
    if (candidate.name == name) return candidate;
  std::vector<std::string_view> names;
  for (const Field& candidate : fields(dimension)) names.push_back(candidate.name);
  throw InputError(
      fmt::format("there is no field \"{}\"; there are {}", name, fmt::join(names, ", ")));
}

std::vector<std::string> columns(const Field& field) {
  if (field.components == 1) return {fmt::format("{}[{}]", field.name, field.unit)};
  const int rows = field.components == 4 ? 2 : 3;
  std::vector<std::string> result;
  for (int k = 0; k < field.components; ++k)
    result.push_back(fmt::format("{}{}{}[{}]", field.name, k / rows + 1, k % rows + 1, field.unit));
  return result;
}

std::vector<double> values(const Field& field, const PointField& points) {
  const auto components = static_cast<std::size_t>(field.components);
  std::vector<double> result(components * points.size());
  for (std::size_t p = 0; p < points.size(); ++p)
    field.value(point_view(points, p), result.data() + components * p);
  return result;
}

Position reference_position(const Mesh& mesh, const PointField& points, std::size_t point) {
  const std::vector<int>& nodes = points.nodes(point);
  Position sum = Position::Zero(mesh.dimension());
  for (std::size_t a = 0; a < nodes.size(); ++a)
    sum += points.geometry(point).shape(static_cast<Eigen::Index>(a)) * mesh.position(nodes[a]);
  return sum;
}

Position current_position(const Mesh& mesh, const PointField& points, std::size_t point,
                          const Eigen::VectorXd& displacement) {
  const std::vector<int>& nodes = points.nodes(point);
  Position sum = reference_position(mesh, points, point);
  for (std::size_t a = 0; a < nodes.size(); ++a)
    sum += points.geometry(point).shape(static_cast<Eigen::Index>(a)) *
           mesh.moved(nodes[a], displacement);
  return sum;
}

}  // namespace verification
