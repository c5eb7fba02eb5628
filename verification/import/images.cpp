#include "import/images.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Vector branch_of(const ForeignPacking& packing, std::size_t i, std::size_t j, const Shift& shift) {
  return Vector::Map(packing.branch({.i = i, .j = j, .shift = shift}).data());
}

}  // namespace

std::vector<Shift> images_in_touch(const ForeignPacking& packing, std::size_t i, std::size_t j) {
  const double radii = packing.radius[i] + packing.radius[j];
  const Matrix to_cells = Matrix::Map(packing.cell.data()).inverse();
  const Vector apart =
      to_cells * (Vector::Map(packing.centre[j].data()) - Vector::Map(packing.centre[i].data()));
  Shift low{}, high{}, nearest{};
  for (int k = 0; k < packing.dimension; ++k) {
    // A row of the inverse is 1 / the distance between two opposite sides.
    const double reach = 2 * radii * to_cells.row(k).norm();
    const auto at = static_cast<std::size_t>(k);
    nearest[at] = static_cast<int>(std::lround(-apart(k)));
    low[at] = static_cast<int>(std::ceil(-apart(k) - reach));
    high[at] = static_cast<int>(std::floor(-apart(k) + reach));
  }
  std::vector<Shift> touching;
  double least = 2 * radii;
  Shift s{};
  for (s[0] = low[0]; s[0] <= high[0]; ++s[0])
    for (s[1] = low[1]; s[1] <= high[1]; ++s[1])
      for (s[2] = low[2]; s[2] <= high[2]; ++s[2]) {
        if (i == j && s <= Shift{}) continue;
        const double length = branch_of(packing, i, j, s).norm();
        if (length < radii) touching.push_back(s);
        if (length > least) continue;
        least = length;
        nearest = s;
      }
  return touching.empty() ? std::vector{nearest} : touching;
}

std::optional<Shift> image_apart(const ForeignPacking& packing, std::size_t i, std::size_t j,
                                 const std::vector<Shift>& images, const Position& apart) {
  const double near = 0.01 * (packing.radius[i] + packing.radius[j]);
  const Vector d = Vector::Map(apart.data());
  std::optional<Shift> found;
  double least = near, second = near;
  for (const Shift& shift : images) {
    const Vector branch = branch_of(packing, i, j, shift);
    const double off = std::min((branch - d).norm(), (branch + d).norm());
    if (off < least) found = shift;
    second = std::min(second, std::max(off, least));
    least = std::min(off, least);
  }
  return 2 * least < second ? found : std::nullopt;
}

}  // namespace verification
