// Systems of spheres by Krylov methods against factors, in an evaluation, and where those methods stall.
#include "sphere_support.hpp"
#include "state/scratch.hpp"

#include <limits>

namespace grainlaw::core::sphere_test {
namespace {

constexpr std::size_t never = std::numeric_limits<std::size_t>::max();

// For this thread while it lives.
class IterateFrom {
 public:
  template <class... Number>
  explicit IterateFrom(Number... number) {
    workspace<3>().newton.stiffness.iterate_from(number...);
  }
  ~IterateFrom() { workspace<3>().newton.stiffness.iterate_from(tuned::iterative_nodes); }
  IterateFrom(const IterateFrom&) = delete;
  IterateFrom& operator=(const IterateFrom&) = delete;
};

int products() { return workspace<3>().newton.stiffness.products(); }

Deformation at(double strain) {
  return {1 + 0.35 * strain, 0.1 * strain, 0, 0, 1 + 0.35 * strain, 0, 0.1 * strain, 0, 1 - strain};
}

std::shared_ptr<const Material<3>> material(double drag) {
  MaterialDescription description = describe(1e-11);
  description.solver.viscosity.number = drag;
  return make_material<3>(description);
}

// The third increment, by whatever way is set for this thread.
Found third_increment(State<3>& state) {
  for (int n = 1; n <= 2; ++n) {
    const IterateFrom factors(never);
    evaluate(state, at(5e-4 * n));
    state.commit();
  }
  return evaluate(state, at(1.5e-3));
}

struct Pair {
  Found by_factors, iterated;
  int products;
};
template <class... Number>
Pair both(double drag, Number... number) {
  State<3> state(material(drag));
  third_increment(state);
  Pair pair{};
  {
    const IterateFrom set(never);
    pair.by_factors = evaluate(state, at(1.5e-3), TangentKind::exact);
  }
  const IterateFrom set(number...);
  const int before = products();
  pair.iterated = evaluate(state, at(1.5e-3), TangentKind::exact);
  pair.products = products() - before;
  return pair;
}

void expect_same(const Pair& pair) {
  EXPECT_GT(pair.products, 0);
  EXPECT_EQ(pair.by_factors.report.tangent_exact, 1);
  EXPECT_EQ(pair.iterated.report.tangent_exact, 1);
  EXPECT_LT(relative_difference(pair.iterated.stress, pair.by_factors.stress), 1e-9);
  EXPECT_LT(relative_difference(pair.iterated.tangent, pair.by_factors.tangent), 1e-7);
}

TEST(iterated_spheres, have_the_stress_and_tangent_that_factors_give) {
  for (const double drag : {0.0, 1e-3}) expect_same(both(drag, std::size_t{1}));
}

TEST(iterated_spheres, are_solved_by_factors_where_the_products_do_not_suffice) {
  for (const double drag : {0.0, 1e-3}) expect_same(both(drag, std::size_t{1}, 8));
}

TEST(iterated_spheres, tangent_matches_central_differences) {
  const IterateFrom set(std::size_t{1});
  State<3> state(material(0));
  const auto found = (third_increment(state), evaluate(state, at(1.5e-3), TangentKind::exact));
  ASSERT_EQ(found.report.tangent_exact, 1);
  double least = 1;
  for (const double step : {1e-7, 1e-8}) {
    least = std::min(
        least, relative_difference(found.tangent, central_differences(state, at(1.5e-3), step)));
  }
  EXPECT_LT(least, 1e-6);
}

TEST(iterated_spheres, few_are_not_iterated) {
  State<3> state(material(0));
  const IterateFrom set(reference_packing().size() + 1);
  const int before = products();
  evaluate(state, at(5e-4), TangentKind::exact);
  EXPECT_EQ(products(), before);
}

TEST(iterated_spheres, same_bits_whatever_was_solved_before) {
  const auto evaluations = [](double strain) {
    State<3> state(material(0));
    return evaluate(state, at(strain), TangentKind::exact);
  };
  const auto alone = evaluations(5e-4);
  evaluations(1e-3);
  const auto again = evaluations(5e-4);
  EXPECT_EQ(alone.stress, again.stress);
  EXPECT_EQ(alone.tangent, again.tangent);
}

}  // namespace
}  // namespace grainlaw::core::sphere_test
