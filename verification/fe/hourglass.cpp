#include "fe/hourglass.hpp"

namespace verification {

Hourglass::Hourglass(const Mesh& mesh, double coefficient, double modulus) {
  if (mesh.kind != ElementKind::q4r || coefficient == 0) return;
  constexpr std::array<double, 4> mode{1, -1, 1, -1};
  for (const auto& element : mesh.elements) {
    const std::vector<Position> corners = mesh.positions(element);
    const QuadPoint point = quad_points(mesh.kind, corners).front();
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();  // h . X
    for (std::size_t a = 0; a < 4; ++a) slope += mode[a] * corners[a];
    Spring spring{element, {}, coefficient * modulus * point.weight * point.gradient.squaredNorm()};
    for (std::size_t a = 0; a < 4; ++a)
      spring.gamma[a] =
          0.25 * (mode[a] - point.gradient.row(static_cast<Eigen::Index>(a)).dot(slope));
    springs_.push_back(spring);
  }
}

Eigen::Vector2d Hourglass::Spring::stretch(const Eigen::VectorXd& displacement) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t a = 0; a < 4; ++a) sum += gamma[a] * displacement.segment<2>(2 * nodes[a]);
  return sum;
}

void Hourglass::add_force(const Eigen::VectorXd& displacement, Eigen::VectorXd& force) const {
  for (const Spring& spring : springs_) {
    const Eigen::Vector2d pull = spring.stiffness * spring.stretch(displacement);
    for (std::size_t a = 0; a < 4; ++a)
      force.segment<2>(2 * spring.nodes[a]) += spring.gamma[a] * pull;
  }
}

void Hourglass::add_stiffness(Triplets& triplets) const {
  for (const Spring& spring : springs_)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b)
        for (int i = 0; i < 2; ++i)
          triplets.emplace_back(2 * spring.nodes[a] + i, 2 * spring.nodes[b] + i,
                                spring.stiffness * spring.gamma[a] * spring.gamma[b]);
}

}  // namespace verification
