#include "fe/output/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

Tensor small_strain(const Tensor& deformation) {
  return 0.5 * (deformation + deformation.transpose()) - Tensor::Identity();
}

Tensor deviator(const Tensor& tensor) { return tensor - 0.5 * tensor.trace() * Tensor::Identity(); }

template <grainlaw_measure what>
void first_component(const PointView& point, double* out) {
  out[0] = measure_scalar(point.state, what);
}

void put(const Tensor& tensor, double* out) { std::copy(tensor.data(), tensor.data() + 4, out); }

constexpr std::array<std::string_view, 4> tensor_components{"11", "12", "21", "22"};

Eigen::Vector2d interpolated(const PointField& points, std::size_t point,
                             const std::vector<Eigen::Vector2d>& at_nodes) {
  const std::vector<int>& nodes = points.nodes(point);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t a = 0; a < nodes.size(); ++a)
    sum += points.geometry(point).shape(static_cast<Eigen::Index>(a)) *
           at_nodes[static_cast<std::size_t>(nodes[a])];
  return sum;
}

}  // namespace

PointView point_view(const PointField& points, std::size_t point) {
  return {points.state(point), points.deformation(point), points.stress(point),
          points.report(point)};
}

const std::vector<Field>& fields() {
  static const std::vector<Field> all{
      {"stress", "Pa", "Cauchy stress", 4,
       [](const PointView& p, double* out) { put(cauchy_stress(p.stress, p.deformation), out); }},
      {"mean_stress", "Pa", "mean stress p, compression +", 1,
       [](const PointView& p, double* out) {
         out[0] = -0.5 * cauchy_stress(p.stress, p.deformation).trace();
       }},
      {"deviatoric_stress", "Pa", "deviatoric stress q", 1,
       [](const PointView& p, double* out) {
         out[0] = std::sqrt(0.5) * deviator(cauchy_stress(p.stress, p.deformation)).norm();
       }},
      {"stress_ratio", "-", "stress ratio |s11 - s22| / |s11 + s22|", 1,
       [](const PointView& p, double* out) {
         const Tensor stress = cauchy_stress(p.stress, p.deformation);
         const double sum = std::abs(stress.trace());
         out[0] = sum > 0 ? std::abs(stress(0, 0) - stress(1, 1)) / sum : 0;
       }},
      {"strain", "-", "strain", 4,
       [](const PointView& p, double* out) { put(small_strain(p.deformation), out); }},
      {"volumetric_strain", "-", "volumetric strain, dilation +", 1,
       [](const PointView& p, double* out) { out[0] = p.deformation.determinant() - 1; }},
      {"deviatoric_strain", "-", "deviatoric strain", 1,
       [](const PointView& p, double* out) {
         out[0] = std::sqrt(2.0) * deviator(small_strain(p.deformation)).norm();
       }},
      {"deformation", "-", "deformation gradient", 4,
       [](const PointView& p, double* out) { put(p.deformation, out); }},
      {"void_ratio", "-", "void ratio", 1, first_component<GRAINLAW_VOID_RATIO>},
      {"coordination", "-", "coordination number", 1, first_component<GRAINLAW_COORDINATION>},
      {"anisotropy", "-", "anisotropy", 1, first_component<GRAINLAW_ANISOTROPY>},
      {"fabric_intensity", "-", "fabric intensity", 1, first_component<GRAINLAW_FABRIC_INTENSITY>},
      {"fabric", "-", "fabric", 4,
       [](const PointView& p, double* out) {
         const std::vector<double> fabric = measure(p.state, GRAINLAW_FABRIC);
         std::copy(fabric.begin(), fabric.end(), out);
       }},
      {"rotation", "rad", "mean particle rotation", 1, first_component<GRAINLAW_MEAN_ROTATION>},
      {"contacts", "-", "contacts", 1, first_component<GRAINLAW_CONTACTS>},
      // 0: direct; 1: the friction history was advanced; 2: no contact is left.
      {"status", "-", "status", 1, [](const PointView& p, double* out) {
         const bool loose = measure_scalar(p.state, GRAINLAW_CONTACTS) == 0;
         out[0] = loose ? 2 : p.report.history_advanced != 0 ? 1 : 0;
       }}};
  return all;
}

const Field& field(std::string_view name) {
  for (const Field& candidate : fields())
    if (candidate.name == name) return candidate;
  std::vector<std::string_view> names;
  for (const Field& candidate : fields()) names.push_back(candidate.name);
  throw InputError(
      fmt::format("there is no field \"{}\"; there are {}", name, fmt::join(names, ", ")));
}

std::vector<std::string> columns(const Field& field) {
  if (field.components == 1) return {fmt::format("{}[{}]", field.name, field.unit)};
  std::vector<std::string> result;
  for (const std::string_view component : tensor_components)
    result.push_back(fmt::format("{}{}[{}]", field.name, component, field.unit));
  return result;
}

std::vector<double> values(const Field& field, const PointField& points) {
  const auto components = static_cast<std::size_t>(field.components);
  std::vector<double> result(components * points.size());
  for (std::size_t p = 0; p < points.size(); ++p)
    field.value(point_view(points, p), result.data() + components * p);
  return result;
}

Eigen::Vector2d reference_position(const Mesh& mesh, const PointField& points, std::size_t point) {
  return interpolated(points, point, mesh.nodes);
}

Eigen::Vector2d current_position(const Mesh& mesh, const PointField& points, std::size_t point,
                                 const Eigen::VectorXd& displacement) {
  const std::vector<int>& nodes = points.nodes(point);
  Eigen::Vector2d sum = reference_position(mesh, points, point);
  for (std::size_t a = 0; a < nodes.size(); ++a)
    sum += points.geometry(point).shape(static_cast<Eigen::Index>(a)) *
           displacement.segment<2>(2 * nodes[a]);
  return sum;
}

}  // namespace verification
