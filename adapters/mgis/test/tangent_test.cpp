// Stresses and tangents in the measures of MGIS, where contacts slide and neither F nor the tangent
// is symmetric: against each other, and against central differences.
#include "mgis_host.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <random>

namespace grainlaw::test {
namespace {

using Matrix = std::array<double, 9>;  // [3 i + J]
constexpr std::array<std::size_t, 6> symmetric_order{0, 4, 8, 1, 2, 5};

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t k = 0; k < 27; ++k)
    c[k / 9 * 3 + k % 3] += a[k / 9 * 3 + k / 3 % 3] * b[k / 3 % 3 * 3 + k % 3];
  return c;
}
Matrix transposed(const Matrix& a) {
  return {a[0], a[3], a[6], a[1], a[4], a[7], a[2], a[5], a[8]};
}
Matrix combined(const Matrix& a, double factor, const Matrix& b) {
  Matrix c;
  for (std::size_t k = 0; k < 9; ++k) c[k] = a[k] + factor * b[k];
  return c;
}
Matrix cofactors(const Matrix& F) {
  Matrix c;
  for (std::size_t k = 0; k < 9; ++k) {
    const std::size_t i = (k / 3 + 1) % 3, j = (k / 3 + 2) % 3;
    const std::size_t I = (k % 3 + 1) % 3, J = (k % 3 + 2) % 3;
    c[k] = F[3 * i + I] * F[3 * j + J] - F[3 * i + J] * F[3 * j + I];
  }
  return c;
}
double determinant(const Matrix& F) {
  const Matrix c = cofactors(F);
  return F[0] * c[0] + F[1] * c[1] + F[2] * c[2];
}
Matrix inverse(const Matrix& F) {
  return combined({}, 1 / determinant(F), transposed(cofactors(F)));
}
Matrix symmetric_part(const Matrix& a) {
  return combined(combined({}, 0.5, a), 0.5, transposed(a));
}
double trace(const Matrix& a) { return a[0] + a[4] + a[8]; }

// Without drag, and with it: then moments act on the particles, and P F^T is not symmetric.
struct Case {
  const char *behaviour, *hypothesis;
};
std::string name_of(const testing::TestParamInfo<Case>& one) {
  return std::string(one.param.behaviour) + one.param.hypothesis;
}
void PrintTo(const Case& one, std::ostream* out) { *out << one.behaviour; }

class mgis_tangent : public testing::TestWithParam<Case> {
 protected:
  BehaviourLibrary library{std::string(GRAINLAW_BEHAVIOURS) + "/lib" + GetParam().behaviour +
                           ".so"};

  // Spheres answer out of the plane too.
  bool spheres() const { return std::string(GetParam().behaviour).starts_with("Spheres"); }
  Matrix before() const {
    if (!spheres()) return {0.9982, 0.0024, 0, -0.0009, 1.0010, 0, 0, 0, 1};
    return {0.9982, 0.0024, -0.0009, -0.0009, 1.0010, 0.0007, 0.0009, -0.0010, 0.9980};
  }
  Matrix after() const {
    if (!spheres()) return {0.9975, 0.0040, 0, -0.0013, 1.0016, 0, 0, 0, 1};
    return {0.9975, 0.0040, -0.0013, -0.0013, 1.0016, 0.0011, 0.0013, -0.0016, 0.9972};
  }

  Manager manager(Stress stress, Tangent tangent) const {
    return {library, GetParam().behaviour, GetParam().hypothesis, 1, stress, tangent};
  }

  struct Result {
    std::vector<double> stress, K;
    std::size_t symmetric;
  };

  // A point led to `before`, then asked at F.
  Result at(const Matrix& F, Stress stress, Tangent tangent) const {
    Manager host = manager(stress, tangent);
    host.set_F_in_space(0, before());
    EXPECT_EQ(host.integrate(0), 1) << host.message;
    host.update();
    host.set_F_in_space(0, F);
    EXPECT_EQ(host.integrate(0), 1) << host.message;
    return {host.s1.forces, host.K, host.symmetric};
  }

  static Matrix full(const std::vector<double>& values, bool symmetric) {
    Matrix tensor{};
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (!symmetric) {
        tensor[tensor_order[k]] = values[k];
      } else {
        const std::size_t place = symmetric_order[k];
        const double value = k < 3 ? values[k] : values[k] / std::numbers::sqrt2;
        tensor[place] = tensor[place % 3 * 3 + place / 3] = value;
      }
    }
    return tensor;
  }
  static std::vector<double> flat(const Matrix& tensor, bool symmetric, std::size_t size) {
    std::vector<double> values(size);
    for (std::size_t k = 0; k < size; ++k) {
      values[k] = symmetric ? (k < 3 ? 1 : std::numbers::sqrt2) * tensor[symmetric_order[k]]
                            : tensor[tensor_order[k]];
    }
    return values;
  }
  // K applied to a variable, as a host does it.
  static Matrix apply(const Result& result, bool rows, bool columns, const Matrix& variable) {
    const std::size_t symmetric = result.symmetric, tensor = symmetric == 4 ? 5 : 9;
    const auto v = flat(variable, columns, columns ? symmetric : tensor);
    std::vector<double> out(rows ? symmetric : tensor);
    for (std::size_t a = 0; a < out.size(); ++a) {
      for (std::size_t b = 0; b < v.size(); ++b) out[a] += result.K[a * v.size() + b] * v[b];
    }
    return full(out, rows);
  }

  static void near(const Matrix& found, const Matrix& expected, double tolerance) {
    double difference = 0, norm = 0;
    for (std::size_t k = 0; k < 9; ++k) {
      difference += (found[k] - expected[k]) * (found[k] - expected[k]);
      norm += expected[k] * expected[k];
    }
    EXPECT_LE(std::sqrt(difference / norm), tolerance);
  }
};

// Nothing but discs, in both hypotheses.
class mgis_out_of_plane : public mgis_tangent {};

TEST_P(mgis_tangent, stresses_are_one_stress_in_three_measures) {
  const Matrix F = after();
  const Matrix P = full(at(after(), first_piola, dP_dF).stress, false);
  const Matrix S = full(at(after(), second_piola, dP_dF).stress, true);
  const Matrix sigma = full(at(after(), cauchy, dP_dF).stress, true);
  near(S, symmetric_part(product(inverse(F), P)), 1e-12);
  const double J = determinant(F);
  near(sigma, combined({}, 1 / J, symmetric_part(product(P, transposed(F)))), 1e-12);
}

// Each pair by the chain rule from dP = A : dF.
TEST_P(mgis_tangent, agree_with_each_other) {
  const Matrix F = after(), F0 = before(), inv = inverse(F);
  const double J = determinant(F);
  const Result first = at(after(), first_piola, dP_dF);
  const Matrix P = full(first.stress, false);
  const Matrix S = product(inv, P);
  const Result spatial = at(after(), cauchy, dsigma_dF);
  const Result material = at(after(), cauchy, dS_dE);
  const Result increment = at(after(), cauchy, dtau_ddF);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int direction = 0; direction < 10; ++direction) {
    Matrix dF{number(random), number(random), 0, number(random), number(random), 0, 0, 0, 0};
    if (spheres()) std::generate(dF.begin(), dF.end(), [&] { return number(random); });
    const Matrix dP = apply(first, false, false, dF);
    const Matrix dtau =
        symmetric_part(combined(product(dP, transposed(F)), 1, product(P, transposed(dF))));
    const Matrix sigma = combined({}, 1 / J, symmetric_part(product(P, transposed(F))));
    const Matrix dsigma = combined(combined({}, 1 / J, dtau), -trace(product(inv, dF)), sigma);
    near(apply(spatial, true, false, dF), dsigma, 1e-12);
    near(apply(increment, true, false, product(dF, inverse(F0))), dtau, 1e-12);
    const Matrix FdF = product(transposed(F), dF);
    const Matrix dE = combined(combined({}, 0.5, FdF), 0.5, transposed(FdF));
    const Matrix dS = product(inv, combined(dP, -1, product(dF, S)));
    near(apply(material, true, true, dE), symmetric_part(dS), 1e-12);
  }
}

TEST_P(mgis_tangent, pairs_match_central_differences) {
  const Matrix F = after(), F0 = before();
  struct Pair {
    Stress stress;
    Tangent tangent;
    bool rows, columns;
  };
  for (const Pair pair :
       {Pair{cauchy, dsigma_dF, true, false}, Pair{second_piola, dS_dE, true, true},
        Pair{first_piola, dP_dF, false, false}, Pair{cauchy, dtau_ddF, true, false}}) {
    const Result result = at(after(), pair.stress, pair.tangent);
    for (std::size_t component = 0; component < 9; ++component) {
      if (!spheres() && (component > 5 || component % 3 == 2)) continue;
      Matrix dF{};
      dF[component] = 1;
      // The step of which the stencil crosses no change of a contact is not known beforehand.
      double best = 1;
      for (const double h : {1e-6, 1e-7, 1e-8}) {
        Matrix plus = F, minus = F;
        plus[component] += h;
        minus[component] -= h;
        const auto stress = [&](const Matrix& where) {
          const Matrix value = full(at(where, pair.stress, pair.tangent).stress, pair.rows);
          if (pair.tangent != dtau_ddF) return value;
          return combined({}, determinant(where), value);
        };
        const Matrix difference = combined({}, 0.5 / h, combined(stress(plus), -1, stress(minus)));
        Matrix variable = dF;
        if (pair.tangent == dS_dE) {
          const Matrix FdF = product(transposed(F), dF);
          variable = combined(combined({}, 0.5, FdF), 0.5, transposed(FdF));
        } else if (pair.tangent == dtau_ddF) {
          variable = product(dF, inverse(F0));
        }
        const Matrix found = apply(result, pair.rows, pair.columns, variable);
        double error = 0, norm = 0;
        for (std::size_t k = 0; k < 9; ++k) {
          error += (found[k] - difference[k]) * (found[k] - difference[k]);
          norm += difference[k] * difference[k];
        }
        best = std::min(best, std::sqrt(error / norm));
      }
      EXPECT_LE(best, 1e-6) << "pair " << pair.tangent << ", component " << component;
    }
  }
}

TEST_P(mgis_tangent, is_not_symmetric_where_contacts_slide) {
  const Result result = at(after(), cauchy, dS_dE);
  double skew = 0, norm = 0;
  for (std::size_t a = 0; a < result.symmetric; ++a) {
    for (std::size_t b = 0; b < result.symmetric; ++b) {
      const double difference =
          result.K[a * result.symmetric + b] - result.K[b * result.symmetric + a];
      skew += difference * difference;
      norm += result.K[a * result.symmetric + b] * result.K[a * result.symmetric + b];
    }
  }
  EXPECT_GT(std::sqrt(skew / norm), 1e-2);
}

// Out of the plane of discs nothing answers but what P = F S carries along.
TEST_P(mgis_out_of_plane, out_of_plane_stress_is_zero_and_turns_with_F) {
  const Result first = at(after(), first_piola, dP_dF);
  const Matrix S = product(inverse(after()), full(first.stress, false));
  for (const std::size_t k : {2, 5, 6, 7, 8}) EXPECT_EQ(full(first.stress, false)[k], 0);
  if (first.symmetric == 4) return;
  for (std::size_t L = 0; L < 2; ++L) {
    Matrix dF{};
    dF[6 + L] = 1;  // dF_3L
    const Matrix dP = apply(first, false, false, dF);
    near(dP, {0, 0, 0, 0, 0, 0, S[L * 3], S[L * 3 + 1], 0}, 1e-12);
  }
}

// A rotation on top of F turns the stress, about any axis; a stretch along 3 only thins it out.
TEST_P(mgis_out_of_plane, stress_turns_with_a_small_rotation) {
  const Matrix F = after(), F0 = before();
  const double J = determinant(F);
  const Result spatial = at(after(), cauchy, dsigma_dF);
  const Result increment = at(after(), cauchy, dtau_ddF);
  const Result first = at(after(), first_piola, dP_dF);
  const Matrix sigma = full(spatial.stress, true);
  const Matrix P = full(first.stress, false);
  std::vector<Matrix> rotations{{0, 1, 0, -1, 0, 0, 0, 0, 0}};
  if (spatial.symmetric == 6) {
    rotations.push_back({0, 0, 1, 0, 0, 0, -1, 0, 0});
    rotations.push_back({0, 0, 0, 0, 0, 1, 0, -1, 0});
  }
  for (const Matrix& W : rotations) {
    const Matrix turned = combined(product(W, sigma), -1, product(sigma, W));
    near(apply(spatial, true, false, product(W, F)), turned, 1e-10);
    near(apply(increment, true, false, product(W, product(F, inverse(F0)))),
         combined({}, J, turned), 1e-10);
    near(apply(first, false, false, product(W, F)), product(W, P), 1e-10);
  }
  const Matrix stretch{0, 0, 0, 0, 0, 0, 0, 0, 1};
  near(apply(spatial, true, false, stretch), combined({}, -1, sigma), 1e-12);
}

TEST_P(mgis_tangent, the_elastic_operator_is_symmetric_in_S_and_E) {
  Manager host = manager(second_piola, dS_dE);
  host.set_F_in_space(0, after());
  for (const double request : {elastic, 2.0}) {
    ASSERT_EQ(host.integrate(0, request), 1) << host.message;
    double skew = 0, norm = 0;
    for (std::size_t a = 0; a < host.symmetric; ++a) {
      for (std::size_t b = 0; b < host.symmetric; ++b) {
        const double value = host.K[a * host.symmetric + b];
        skew = std::max(skew, std::abs(value - host.K[b * host.symmetric + a]));
        norm = std::max(norm, std::abs(value));
      }
    }
    EXPECT_GT(norm, 1e6);
    EXPECT_LE(skew / norm, 1e-2);
  }
}

constexpr Case cases[] = {{"Sharp", "PlaneStrain"},       {"Sharp", "Tridimensional"},
                          {"SharpInTime", "PlaneStrain"}, {"SharpInTime", "Tridimensional"},
                          {"Spheres", "Tridimensional"},  {"SpheresInTime", "Tridimensional"}};
INSTANTIATE_TEST_SUITE_P(, mgis_tangent, testing::ValuesIn(cases), name_of);
INSTANTIATE_TEST_SUITE_P(, mgis_out_of_plane, testing::ValuesIn(cases, cases + 4), name_of);

}  // namespace
}  // namespace grainlaw::test
