#include "fe/strain_average.hpp"

#include "fe/dimension.hpp"

#include <vector>

namespace verification {

StrainAverage::StrainAverage(const Mesh& mesh, double length, double modulus)
    : dimension_(mesh.dimension()) {
  const auto n = static_cast<Eigen::Index>(mesh.nodes.size());
  Eigen::MatrixXd smooth = Eigen::MatrixXd::Zero(n, n);  // of N N + l^2 grad N . grad N
  std::vector<Eigen::MatrixXd> slope(static_cast<std::size_t>(dimension_),
                                     smooth);  // of N_a dN_b/dX_J
  stiffness_ = smooth;                         // of grad N . grad N
  for (const auto& element : mesh.elements)
    for (const auto& [gradient, weight, shape] : quad_points(mesh.kind, mesh.positions(element)))
      for (std::size_t a = 0; a < element.size(); ++a)
        for (std::size_t b = 0; b < element.size(); ++b) {
          const auto i = static_cast<Eigen::Index>(a), k = static_cast<Eigen::Index>(b);
          const double along = weight * gradient.row(i).dot(gradient.row(k));
          stiffness_(element[a], element[b]) += along;
          smooth(element[a], element[b]) += weight * shape(i) * shape(k) + length * length * along;
          for (std::size_t J = 0; J < slope.size(); ++J)
            slope[J](element[a], element[b]) +=
                weight * shape(i) * gradient(k, static_cast<Eigen::Index>(J));
        }
  const Eigen::LLT<Eigen::MatrixXd> factor(smooth);
  for (const Eigen::MatrixXd& part : slope) stiffness_ -= part.transpose() * factor.solve(part);
  stiffness_ = 0.5 * modulus * (stiffness_ + stiffness_.transpose().eval());
}

void StrainAverage::add_force(const Eigen::VectorXd& displacement, Eigen::VectorXd& force) const {
  if (stiffness_.size() == 0) return;
  in_dimension(dimension_, [&]<int D>() {
    using Nodes = Eigen::Matrix<double, D, Eigen::Dynamic>;
    const Eigen::Map<const Nodes> u(displacement.data(), D, stiffness_.rows());
    Eigen::Map<Nodes>(force.data(), D, stiffness_.rows()) += u * stiffness_;
  });
}

void StrainAverage::add_stiffness(Triplets& triplets) const {
  for (int a = 0; a < stiffness_.rows(); ++a)
    for (int b = 0; b < stiffness_.cols(); ++b)
      for (int i = 0; i < dimension_; ++i)
        triplets.emplace_back(dimension_ * a + i, dimension_ * b + i, stiffness_(a, b));
}

}  // namespace verification
