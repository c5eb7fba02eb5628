// A law in time: what it is told of the time of its increments, what it is not told, and what bytes
// keep of it; and the law whose time is the strain.
#include "support.hpp"

#include <cmath>
#include <limits>

namespace grainlaw::test {
namespace {

Material in_time(const std::string& solver) {
  return Material::parse(read_text(material_path) + "\n[solver]\n" + solver, data_directory);
}
constexpr double memory = 2;  // of the law below, in the unit of the host's time
const Material& law_in_time() {
  static const Material instance = in_time("viscous_number = 1e-3\nviscous_rate = 5e-4\n");
  return instance;
}

grainlaw_report refused(State& state, const Tensor& F) {
  grainlaw_report report = grainlaw_report_default();
  EXPECT_EQ(grainlaw_evaluate(state.get(), F.data(), 0, nullptr, nullptr, &report),
            GRAINLAW_BAD_ARGUMENT);
  return report;
}

double distance(const Tensor& a, const Tensor& b) {
  double squares = 0, norm = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    squares += (a[k] - b[k]) * (a[k] - b[k]);
    norm += b[k] * b[k];
  }
  return std::sqrt(squares / norm);
}

TEST(time_step, is_asked_for_before_the_first_increment) {
  State state(law_in_time());
  stress(state, identity);  // of the start
  const grainlaw_report report = refused(state, compressed);
  EXPECT_NE(std::string(report.message).find("viscous_rate"), std::string::npos);
  EXPECT_NE(std::string(report.message).find("grainlaw_state_set_time_step"), std::string::npos);
  EXPECT_EQ(report.step_ratio, 0);
  EXPECT_EQ(grainlaw_commit(state.get()), GRAINLAW_NO_TRIAL);
  state.set_time_step(memory);
  stress(state, compressed);
}

// Norm of sym(U - 1), with U the stretch of F.
double strain(const Tensor& F) {
  const double a = F[0] * F[0] + F[2] * F[2], b = F[0] * F[1] + F[2] * F[3];
  const double d = F[1] * F[1] + F[3] * F[3], root = std::sqrt(a * d - b * b);
  const double scale = std::sqrt(a + d + 2 * root);
  const double xx = (a + root) / scale - 1, xy = b / scale, yy = (d + root) / scale - 1;
  return std::sqrt(xx * xx + 2 * xy * xy + yy * yy);
}

TEST(time_step, is_the_strain_where_none_is_told) {
  State plain(in_time("viscous_number = 1e-3\n")), timed(law_in_time());
  timed.set_time_step(memory * strain(compressed) / 1e-3);
  const Tensor expected = stress(timed, compressed);
  EXPECT_LT(distance(stress(plain, compressed), expected), 1e-8);
  plain.commit();
  EXPECT_LT(distance(stress(plain, compressed), expected), 1e-8);  // and a hold is none
}

TEST(time_step, of_nothing_is_for_an_increment_of_nothing) {
  State state(law_in_time());
  state.set_time_step(memory);
  const Tensor before = stress(state, compressed);
  state.commit();
  state.set_time_step(0);
  refused(state, further);
  EXPECT_LT(distance(stress(state, compressed), before), 1e-6);
  state.commit();
  State longer = state;
  longer.set_time_step(100 * memory);  // drag fades meanwhile
  EXPECT_GT(distance(stress(longer, compressed), before), 1e-4);
}

// Drag is a spring then.
TEST(time_step, may_be_as_short_as_it_likes) {
  const auto at = [](double step) {
    State state(law_in_time());
    state.set_time_step(step);
    const Tensor first = stress(state, compressed);
    state.commit();
    stress(state, further);
    return first;
  };
  const Tensor none = at(1e-300);
  for (const double step : {1e-12, 1e-6, 1e-4}) EXPECT_LT(distance(at(step), none), 1e-4) << step;
  EXPECT_GT(distance(at(memory), none), 1e-2);
}

TEST(time_step, is_in_saved_bytes_and_in_copies) {
  State state(law_in_time());
  state.set_time_step(0.5);
  stress(state, compressed);
  state.commit();
  State loaded(law_in_time()), copy = state;
  loaded.load(state.save());
  const Tensor next = stress(state, further);
  EXPECT_TRUE(same_bits(stress(loaded, further), next));
  EXPECT_TRUE(same_bits(stress(copy, further), next));
  loaded.set_time_step(2);
  EXPECT_FALSE(same_bits(stress(loaded, further), next));
}

TEST(time_step, that_was_never_told_is_none_in_saved_bytes_either) {
  State state(law_in_time()), loaded(law_in_time());
  loaded.set_time_step(1);
  loaded.load(state.save());
  refused(loaded, compressed);
}

TEST(time_step, is_kept_by_a_law_whose_time_is_the_strain) {
  State asks(law_in_time()), plain(in_time("viscous_number = 1e-3\n"));
  plain.set_time_step(memory);
  asks.load(plain.save());  // of a material that differs in this alone
  const Tensor loaded = stress(asks, compressed);
  State told(law_in_time());
  told.set_time_step(memory);
  EXPECT_TRUE(same_bits(loaded, stress(told, compressed)));
}

TEST(bad_time_step, is_refused) {
  State state(law_in_time());
  for (const double step : {-1.0, -0.5, std::numeric_limits<double>::infinity(), std::nan("")}) {
    expect_refused(grainlaw_state_set_time_step(state.get(), step), GRAINLAW_BAD_ARGUMENT,
                   "time step " + std::to_string(step));
  }
}

TEST(bad_time_step, keys_of_the_law_before_are_refused_with_those_that_took_their_place) {
  const std::array<std::array<const char*, 2>, 3> keys{{{"viscous_time = 100", "viscous_number"},
                                                        {"viscous_inertia = 1", "viscous_number"},
                                                        {"viscous_increment = 1", "viscous_rate"}}};
  for (const auto& [old_key, new_key] : keys) {
    try {
      in_time(old_key);
      ADD_FAILURE() << old_key << " was read";
    } catch (const StatusError& error) {
      EXPECT_NE(std::string(error.what()).find(new_key), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace grainlaw::test
