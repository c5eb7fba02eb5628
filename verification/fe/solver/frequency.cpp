#include "fe/solver/frequency.hpp"

#include <cmath>

namespace verification {

double highest_frequency(const PointField& points, const Dofs& dofs, const Eigen::VectorXd& mass) {
  Triplets triplets;
  points.add_stiffness(triplets);
  Eigen::SparseMatrix<double> stiffness(mass.size(), mass.size());
  stiffness.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::VectorXd scale = dofs.reduce_mass(mass).cwiseSqrt().cwiseInverse();
  // Start vector: neighbouring nodes with opposite signs, the shape of the highest modes, plus a
  // part of all modes.
  Eigen::VectorXd vector(dofs.unknowns);
  for (Eigen::Index k = 0; k < vector.size(); ++k)
    vector(k) = (k / points.dimension() % 2 == 0 ? 1 : -1) *
                (1 + 0.5 * std::sin(3.0 * static_cast<double>(k * k)));
  vector.normalize();
  double square = 0;
  constexpr int iterations = 300;
  for (int k = 0; k < iterations; ++k) {
    const Eigen::VectorXd full = dofs.expand(scale.cwiseProduct(vector));
    const Eigen::VectorXd force = 0.5 * (stiffness * full + stiffness.transpose() * full);
    const Eigen::VectorXd next = scale.cwiseProduct(dofs.reduce(force));
    square = next.norm();
    if (square == 0) return 0;
    vector = next / square;
  }
  return std::sqrt(square);
}

}  // namespace verification
