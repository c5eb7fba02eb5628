// Tensors in two and three dimensions against Eigen's.
#include "math/tensor.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <type_traits>

namespace grainlaw::core {
namespace {

template <class Dimensions>
struct tensor : testing::Test {
  static constexpr int D = Dimensions::value;
  using Matrix = Eigen::Matrix<double, D, D, Eigen::RowMajor>;
  using Vector = Eigen::Matrix<double, D, 1>;

  std::mt19937 random{31};

  double number() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  Tensor<D> any_tensor() {
    Tensor<D> result;
    for (double& value : result) value = number();
    return result;
  }
  Vec<D> any_vector() {
    Vec<D> result;
    for (double& value : result) value = number();
    return result;
  }
  static Matrix matrix(const Tensor<D>& a) { return Eigen::Map<const Matrix>(a.data()); }
  static Vector vector(const Vec<D>& x) { return Eigen::Map<const Vector>(x.data()); }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(tensor, Dimensions);

constexpr int times = 50;
constexpr double rounding = 1e-14;

TYPED_TEST(tensor, determinant_is_that_of_eigen) {
  constexpr int D = TestFixture::D;
  for (int k = 0; k < times; ++k) {
    const auto a = this->any_tensor();
    EXPECT_NEAR(determinant<D>(a), this->matrix(a).determinant(), rounding);
    EXPECT_EQ(determinant<D>(a.data()), determinant<D>(a));
  }
  EXPECT_EQ(determinant<D>(identity<D>()), 1);
  auto flat = this->any_tensor();  // the first column twice
  for (std::size_t i = 0; i < D; ++i) flat[D * i + 1] = flat[D * i];
  EXPECT_NEAR(determinant<D>(flat), 0, rounding);
}

TYPED_TEST(tensor, inverse_is_that_of_eigen) {
  constexpr int D = TestFixture::D;
  for (int k = 0; k < times; ++k) {
    const auto a = this->any_tensor();
    const auto expected = this->matrix(a).inverse().eval();
    const auto condition = this->matrix(a).norm() * expected.norm();
    EXPECT_LE((this->matrix(inverse<D>(a)) - expected).norm(),
              rounding * condition * expected.norm());
    const auto product_with_itself = product<D>(inverse<D>(a), a);
    EXPECT_LE((this->matrix(product_with_itself) - this->matrix(identity<D>())).norm(),
              rounding * condition);
  }
  EXPECT_EQ(inverse<D>(identity<D>()), identity<D>());
  EXPECT_FALSE(std::isfinite(inverse<D>(Tensor<D>{})[0]));
}

TYPED_TEST(tensor, products_are_those_of_eigen) {
  constexpr int D = TestFixture::D;
  for (int k = 0; k < times; ++k) {
    const auto a = this->any_tensor();
    const auto b = this->any_tensor();
    const auto x = this->any_vector();
    EXPECT_LE((this->matrix(product<D>(a, b)) - this->matrix(a) * this->matrix(b)).norm(),
              rounding);
    EXPECT_LE((this->vector(product<D>(a, x)) - this->matrix(a) * this->vector(x)).norm(),
              rounding);
    EXPECT_EQ(product<D>(a, identity<D>()), a);
    EXPECT_EQ(product<D>(identity<D>(), x), x);
  }
}

TYPED_TEST(tensor, transpose_trace_and_lengths_are_those_of_eigen) {
  constexpr int D = TestFixture::D;
  for (int k = 0; k < times; ++k) {
    const auto a = this->any_tensor();
    const auto x = this->any_vector();
    const auto y = this->any_vector();
    EXPECT_EQ(this->matrix(transpose<D>(a)), this->matrix(a).transpose());
    EXPECT_NEAR(trace<D>(a), this->matrix(a).trace(), rounding);
    EXPECT_NEAR(dot<D>(x.data(), y.data()), this->vector(x).dot(this->vector(y)), rounding);
    EXPECT_NEAR(dot<D>(x.data(), a.data() + 1, D), this->vector(x).dot(this->matrix(a).col(1)),
                rounding);
    EXPECT_NEAR(square<D>(x), this->vector(x).squaredNorm(), rounding);
    EXPECT_NEAR(length<D>(x), this->vector(x).norm(), rounding);
  }
}

TYPED_TEST(tensor, is_the_first_part_of_numbers_with_room_for_three_dimensions) {
  constexpr int D = TestFixture::D;
  const std::array<double, 9> numbers{1, 2, 3, 4, 5, 6, 7, 8, 9};
  const auto a = tensor_of<D>(numbers);
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k], numbers[k]);
  EXPECT_EQ(tensor_of<D>(numbers.data()), a);
}

TEST(tensor_in_the_plane, largest_singular_value_is_that_of_eigen) {
  std::mt19937 random(32);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int k = 0; k < times; ++k) {
    Tensor<2> a;
    for (double& value : a) value = uniform(random);
    const Eigen::Matrix2d matrix = Eigen::Map<const Eigen::Matrix2d>(a.data());
    EXPECT_NEAR(largest_singular_value<2>(a), matrix.jacobiSvd().singularValues()[0], rounding);
  }
}

}  // namespace
}  // namespace grainlaw::core
