#include "evidence/studies/stability/closed_forms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace verification::stability {
namespace {

constexpr double radius = 5e-3;     // [m]
constexpr double thickness = 0.1;   // [m]
constexpr double column_width = 4;  // of a column's cell, in largest radii

using Vector = Eigen::Vector2d;

double stiffness(double young, double a, double b) { return young * 2 * a * b / (a + b); }

// One contact of the lattice per direction, each pair of discs once.
struct Branch {
  Vector reference;       // L [m]
  Vector now;             // l at the last point [m]
  double tangential = 0;  // force there, along the normal turned by +90 degrees [N]
};

struct Force {
  double normal = 0;    // [N]
  double rotation = 0;  // of the branch since the last point [rad]
  double length = 0;    // [m]
};

// The moment of the tangential forces about a disc that turned by `turn`, twice [N m].
double moment(const std::array<Branch, 3>& branches, const std::array<Force, 3>& forces,
              const Contact& contact, double kt, double rotation,
              std::array<double, 3>& tangential) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double trial =
        branches[c].tangential - kt * forces[c].length * (forces[c].rotation - rotation);
    const double bound = contact.friction * forces[c].normal;
    tangential[c] = std::clamp(trial, -bound, bound);
    sum += forces[c].length * tangential[c];
  }
  return sum;
}

// Tangential forces in moment equilibrium; the moment grows with the rotation.
std::array<double, 3> balance(const std::array<Branch, 3>& branches,
                              const std::array<Force, 3>& forces, const Contact& contact,
                              double kt) {
  std::array<double, 3> tangential{};
  double low = -1;
  double high = 1;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (moment(branches, forces, contact, kt, middle, tangential) > 0 ? high : low) = middle;
  }
  moment(branches, forces, contact, kt, 0.5 * (low + high), tangential);
  return tangential;
}

}  // namespace

TinyPacking lattice(int discs, double distance) {
  const double d = distance;
  const double h = std::sqrt(3.0) / 2 * d;
  TinyPacking packing;
  packing.thickness = thickness;
  if (discs == 2) {
    packing.discs = {{0, 0, radius}, {0.5 * d, h, radius}};
    packing.cell << d, 0, 0, 2 * h;
  } else {
    packing.discs = {{0, 0, radius}, {0.5 * d, h, radius}, {d, 2 * h, radius}};
    packing.cell << 1.5 * d, 0, h, 2 * h;
  }
  return packing;
}

TinyPacking column(const std::vector<double>& radii, double young, double force) {
  TinyPacking packing;
  packing.thickness = thickness;
  double y = 0;
  for (std::size_t k = 0; k < radii.size(); ++k) {
    const double next = radii[(k + 1) % radii.size()];
    packing.discs.push_back({0, y, radii[k]});
    y += radii[k] + next - force / stiffness(young, radii[k], next);
  }
  packing.cell << column_width * *std::max_element(radii.begin(), radii.end()), 0, 0, y;
  return packing;
}

std::vector<Tensor> lattice_stress(const std::vector<Point>& points, double distance,
                                   const Contact& contact) {
  const double d = distance;
  const double h = std::sqrt(3.0) / 2 * d;
  const double volume = d * h * thickness;
  const double kn = stiffness(contact.young, radius, radius);
  const double kt = contact.ratio * kn;
  std::array<Branch, 3> branches{Branch{{d, 0}, {d, 0}}, Branch{{0.5 * d, h}, {0.5 * d, h}},
                                 Branch{{-0.5 * d, h}, {-0.5 * d, h}}};
  std::vector<Tensor> stresses;
  for (const Point& point : points) {
    std::array<Force, 3> forces;
    std::array<Vector, 3> now;
    for (std::size_t c = 0; c < 3; ++c) {
      now[c] = point.deformation * branches[c].reference;
      const Vector& before = branches[c].now;
      forces[c].length = now[c].norm();
      forces[c].normal = kn * std::max(0.0, 2 * radius - forces[c].length);
      forces[c].rotation =
          std::atan2(before.x() * now[c].y() - before.y() * now[c].x(), before.dot(now[c]));
    }
    std::array<double, 3> tangential{};
    if (contact.friction > 0 && kt > 0) tangential = balance(branches, forces, contact, kt);
    Tensor stress = Tensor::Zero();
    for (std::size_t c = 0; c < 3; ++c) {
      branches[c].now = now[c];
      branches[c].tangential = tangential[c];
      const Vector normal = now[c] / forces[c].length;
      const Vector force =
          forces[c].normal * normal + tangential[c] * Vector(-normal.y(), normal.x());
      stress -= force * branches[c].reference.transpose() / volume;
    }
    stresses.push_back(stress);
  }
  return stresses;
}

Tensor column_stress(const Tensor& deformation, const TinyPacking& packing, double young) {
  double compliance = 0;  // [m/N]
  double reach = 0;       // [m]
  for (std::size_t k = 0; k < packing.discs.size(); ++k) {
    const double a = packing.discs[k].radius;
    const double b = packing.discs[(k + 1) % packing.discs.size()].radius;
    compliance += 1 / stiffness(young, a, b);
    reach += a + b;
  }
  const double height = packing.cell(1, 1);
  const double force = std::max(0.0, reach - height * deformation(1, 1)) / compliance;
  Tensor stress = Tensor::Zero();
  stress(1, 1) = -force / (packing.cell(0, 0) * packing.thickness);
  return stress;
}

}  // namespace verification::stability
