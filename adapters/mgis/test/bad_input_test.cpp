// What a host may get wrong: -1 and a text in error_message, nothing of the host's changed, and the
// state as it was committed.
#include "../../point/test/traps.hpp"
#include "mgis_host.hpp"
#include "temporary_directory.hpp"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>

namespace grainlaw::test {
namespace {

using F2 = std::array<double, 4>;
constexpr F2 first{0.9996, 0.0003, -0.0001, 1.0002};
constexpr F2 second{0.9990, 0.0012, -0.0004, 1.0005};
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class mgis_bad_input : public testing::Test {
 protected:
  BehaviourLibrary library{std::string(GRAINLAW_BEHAVIOURS) + "/libRve400.so"};
  Manager host{library, "Rve400", "Tridimensional", 2, cauchy, dsigma_dF};

  void SetUp() override {
    for (std::size_t p = 0; p < 2; ++p) {
      host.set_F(p, first);
      ASSERT_EQ(host.integrate(p), 1) << host.message;
    }
    host.update();
    for (std::size_t p = 0; p < 2; ++p) {
      host.set_F(p, second);
      ASSERT_EQ(host.integrate(p), 1) << host.message;
    }
    good_ = host.s1;
  }

  // The wrong call fails with the text, and without a signal where the host traps; afterwards the
  // right one gives what it gave before.
  void refused(const char* text, const std::function<void(Manager&)>& spoil,
               double request = consistent) {
    Manager wrong = host;
    spoil(wrong);
    const Manager::State before = wrong.s1;
    const std::vector<double> K = wrong.K;
    {
      const Traps traps;
      EXPECT_EQ(wrong.integrate(0, request), -1) << text;
      EXPECT_TRUE(Traps::there());
    }
    EXPECT_NE(wrong.message.find(text), std::string::npos) << wrong.message;
    EXPECT_EQ(wrong.message.rfind("Rve400: ", 0), 0u) << wrong.message;
    EXPECT_EQ(wrong.s1.forces, before.forces);
    EXPECT_EQ(wrong.s1.internal, before.internal);
    EXPECT_TRUE(std::equal(K.begin() + 3, K.end(), wrong.K.begin() + 3));
    for (std::size_t p = 0; p < 2; ++p) {
      host.set_F(p, second);
      ASSERT_EQ(host.integrate(p), 1) << host.message;
    }
    EXPECT_EQ(host.s1.forces, good_.forces);
  }

 private:
  Manager::State good_;
};

TEST_F(mgis_bad_input, gradients_that_are_no_numbers) {
  refused("F12 of the deformation gradient is nan", [](Manager& m) { m.s1.gradients[3] = nan; });
  refused("F33 of the deformation gradient is inf",
          [](Manager& m) { m.s1.gradients[2] = std::numeric_limits<double>::infinity(); });
}

TEST_F(mgis_bad_input, gradients_at_the_start_that_are_no_numbers) {
  for (std::size_t k = 0; k < host.tensor; ++k) {
    refused("of the deformation gradient is nan", [k](Manager& m) {
      m.s0.gradients = m.s1.gradients;  // an accepted step
      m.s0.internal = m.s1.internal;
      m.s0.gradients[k] = nan;
    });
    refused("of the deformation gradient is nan", [k](Manager& m) { m.s0.gradients[k] = nan; });
  }
}

TEST_F(mgis_bad_input, gradients_out_of_the_plane_of_discs) {
  refused("F33 is 1.01", [](Manager& m) { m.s1.gradients[2] = 1.01; });
  refused("F31 is 0.002", [](Manager& m) { m.s1.gradients[6] = 0.002; });
}

TEST_F(mgis_bad_input, an_inverted_element_is_told_and_the_step_is_cut) {
  refused("det F", [](Manager& m) { m.set_F(0, {-1, 0, 0, 1}); });
}

TEST_F(mgis_bad_input, states_that_are_not_known) {
  refused("name no state of this process", [](Manager& m) { m.s0.internal[0] = 17; });
  refused("name no state of this process", [](Manager& m) { m.s0.internal[0] = nan; });
  refused("name no state of this process", [](Manager& m) { m.s0.internal[0] = -3; });
  refused("name no state of this process", [](Manager& m) { m.s0.internal[1] = nan; });
  refused("name no state of this process", [](Manager& m) { m.s0.internal[1] = 0; });
  refused("the token is 5", [](Manager& m) { m.s0.internal[1] = 5; });
}

TEST_F(mgis_bad_input, two_points_with_one_state) {
  refused("two points hold the same token", [](Manager& m) {
    std::copy_n(&m.s0.internal[2], 2, &m.s0.internal[0]);
    m.s0.gradients[0] += 1e-3;
  });
}

TEST_F(mgis_bad_input, requests_that_are_not_known) {
  refused(
      "speed of sound", [](Manager&) {}, 104);
  refused(
      "not finite", [](Manager&) {}, nan);
}

TEST_F(mgis_bad_input, null_pointers) {
  const Traps traps;
  auto* integrate = library.symbol<int(mfront_gb_BehaviourData*)>("Rve400_PlaneStrain");
  EXPECT_EQ(integrate(nullptr), -1);
  mfront_gb_BehaviourData data{};
  EXPECT_EQ(integrate(&data), -1);
  std::array<char, 512> text{};
  data.error_message = text.data();
  EXPECT_EQ(integrate(&data), -1);
  EXPECT_STREQ(text.data(), "Rve400: K is a null pointer");
  double K[3] = {0, 7, 0};
  data.K = K;
  EXPECT_EQ(integrate(&data), -1);
  EXPECT_STREQ(text.data(), "Rve400: s0.gradients is a null pointer");
  const double F[5] = {1, 1, 1, 0, 0};
  double internal[2] = {0, 0};
  data.s0.gradients = F;
  data.s0.internal_state_variables = internal;
  EXPECT_EQ(integrate(&data), -1);
  EXPECT_STREQ(text.data(), "Rve400: K[1], the stress measure, is 7; 0 to 2 were expected");
}

TEST_F(mgis_bad_input, a_host_without_message_buffer_and_rdt) {
  host.set_F(0, {1.6, 0, 0, 1});
  EXPECT_EQ(host.call(0, consistent, nullptr, nullptr), -1);
}

// Discs that do not turn carry moments: in shear S12 and S21 differ.
class mgis_moments : public testing::Test {
 protected:
  static constexpr F2 sheared{1, 1e-3, 0, 1};
  static constexpr F2 sheared_on{1, 2e-3, 0, 1};
  BehaviourLibrary library{std::string(GRAINLAW_BEHAVIOURS) + "/libLocked.so"};

  Manager manager(Stress stress, Tangent tangent) const {
    return {library, "Locked", "PlaneStrain", 1, stress, tangent};
  }
  static std::vector<double> evaluate(Manager& host, const F2& F) {
    host.set_F(0, F);
    EXPECT_EQ(host.integrate(0), 1) << host.message;
    return host.s1.forces;
  }
};

TEST_F(mgis_moments, leave_the_first_piola_kirchhoff_stress) {
  Manager host = manager(first_piola, dP_dF);
  const std::vector<double> P = evaluate(host, sheared);
  EXPECT_GT(std::abs(P[3] - P[4]), 1e-2 * std::abs(P[0]));
  host.set_F(0, sheared);
  EXPECT_EQ(host.integrate(0, no_tangent), 1) << host.message;
}

TEST_F(mgis_moments, are_refused_where_a_symmetric_stress_or_tangent_is_asked_for) {
  const auto refuses = [](Manager host, double request) {
    host.set_F(0, sheared_on);
    const Manager::State before = host.s1;
    EXPECT_EQ(host.integrate(0, request), -1);
    EXPECT_NE(host.message.find("the stress of this packing is not symmetric (S12 and S21 differ"),
              std::string::npos)
        << host.message;
    EXPECT_NE(host.message.find("or the first Piola-Kirchhoff stress"), std::string::npos);
    EXPECT_EQ(host.s1.forces, before.forces);
    EXPECT_EQ(host.s1.internal, before.internal);
  };
  for (const Stress stress : {cauchy, second_piola}) {
    refuses(manager(stress, dP_dF), no_tangent);
    refuses(manager(stress, dP_dF), elastic);
    refuses(manager(stress, dP_dF), consistent);
  }
  for (const Tangent tangent : {dsigma_dF, dS_dE, dtau_ddF}) {
    refuses(manager(first_piola, tangent), consistent);
  }
}

TEST_F(mgis_moments, refused_leave_the_state_as_it_was) {
  Manager host = manager(first_piola, dP_dF), plain = manager(first_piola, dP_dF);
  evaluate(host, sheared);
  evaluate(plain, sheared);
  host.update();
  plain.update();
  Manager wrong = manager(second_piola, dS_dE);
  wrong.s0.gradients = host.s0.gradients;
  wrong.s0.internal = host.s0.internal;
  wrong.set_F(0, sheared_on);
  for (const double request : {consistent, no_tangent, -1.0}) {
    EXPECT_EQ(wrong.integrate(0, request), -1);
    EXPECT_NE(wrong.message.find("not symmetric"), std::string::npos) << wrong.message;
  }
  EXPECT_EQ(evaluate(host, sheared_on), evaluate(plain, sheared_on));
}

TEST(mgis_material, rounding_in_a_stress_of_nothing_is_no_moment) {
  const BehaviourLibrary library(std::string(GRAINLAW_BEHAVIOURS) + "/libUnloaded.so");
  for (const double request : {no_tangent, consistent}) {
    Manager host(library, "Unloaded", "PlaneStrain", 1, second_piola, dS_dE);
    EXPECT_EQ(host.integrate(0, request), 1) << host.message;
    EXPECT_LE(std::abs(host.s1.forces[0]), 1e-6);  // Pa
    host.update();
    host.set_F(0, {1, 1e-6, 0, 1});
    EXPECT_EQ(host.integrate(0, request), 1) << host.message;
  }
}

// A host whose working directory is another by the time it first asks.
class mgis_elsewhere : public testing::Test {
 protected:
  ~mgis_elsewhere() override { std::filesystem::current_path(before); }

  static int first_answer(const BehaviourLibrary& library, const char* behaviour,
                          std::string& message) {
    std::filesystem::current_path("/");
    Manager host(library, behaviour, "PlaneStrain", 1, cauchy, dsigma_dF);
    const int result = host.integrate(0);
    message = host.message;
    return result;
  }
  const std::filesystem::path before = std::filesystem::current_path();
  // The adapter itself is loaded before.
  BehaviourLibrary another{std::string(GRAINLAW_BEHAVIOURS) + "/libSmall.so"};
  std::string message;
};

TEST_F(mgis_elsewhere, a_library_found_by_a_relative_path_finds_its_material) {
  std::filesystem::current_path(GRAINLAW_BEHAVIOURS "/..");
  const BehaviourLibrary library("./behaviours/libByHand.so");
  EXPECT_EQ(first_answer(library, "Beside", message), 1) << message;
}

TEST_F(mgis_elsewhere, a_relative_name_in_the_environment_starts_where_the_host_did) {
  const auto path = std::filesystem::path(GRAINLAW_TEST_DATA "/bonded100.toml");
  setenv("GRAINLAW_MATERIAL_Named", path.lexically_relative(before).c_str(), 1);
  const BehaviourLibrary library(GRAINLAW_BEHAVIOURS "/libByHand.so");
  EXPECT_EQ(first_answer(library, "Named", message), 1) << message;
  unsetenv("GRAINLAW_MATERIAL_Named");
}

// A locale that writes a comma is made here, since few machines have one.
TEST(mgis_material, numbers_are_the_same_in_any_locale) {
  const TemporaryDirectory directory;
  const std::string name = "de_DE.UTF-8";
  const std::string make =
      "localedef --no-archive -i de_DE -f UTF-8 " + (directory / name).string();
  if (std::system((make + " 2>/dev/null").c_str()) != 0) GTEST_SKIP() << "no localedef";
  setenv("LOCPATH", directory.string().c_str(), 1);
  ASSERT_NE(std::setlocale(LC_ALL, name.c_str()), nullptr);
  ASSERT_STREQ(std::localeconv()->decimal_point, ",");
  setenv("GRAINLAW_IDLE_MEMORY", "0.5", 1);
  const BehaviourLibrary library(GRAINLAW_BEHAVIOURS "/libSmall.so");
  Manager host(library, "Small", "Tridimensional", 1, cauchy, dsigma_dF);
  EXPECT_EQ(host.integrate(0), 1) << host.message;
  host.s1.gradients[2] = 1.5;
  EXPECT_EQ(host.integrate(0), -1);
  EXPECT_NE(host.message.find("F33 is 1.5"), std::string::npos) << host.message;
  std::setlocale(LC_ALL, "C");
  unsetenv("GRAINLAW_IDLE_MEMORY");
  unsetenv("LOCPATH");
}

TEST(mgis_material, a_missing_file_is_named_and_may_come_later) {
  const std::string folder = GRAINLAW_BEHAVIOURS;
  const BehaviourLibrary library(folder + "/libByHand.so");
  Manager host(library, "Missing", "PlaneStrain", 1, cauchy, dsigma_dF);
  for (int attempt = 0; attempt < 2; ++attempt) {
    EXPECT_EQ(host.integrate(0), -1);
    EXPECT_NE(host.message.find(folder + "/no_such_material.toml"), std::string::npos)
        << host.message;
  }
}

TEST(mgis_material, a_budget_that_is_no_number_is_told) {
  setenv("GRAINLAW_IDLE_MEMORY", "much", 1);
  const BehaviourLibrary library(std::string(GRAINLAW_BEHAVIOURS) + "/libByHand.so");
  Manager host(library, "Named", "PlaneStrain", 1, cauchy, dsigma_dF);
  EXPECT_EQ(host.integrate(0), -1);
  EXPECT_EQ(host.message, "Named: GRAINLAW_IDLE_MEMORY is 'much'; a number of MiB was expected");
  unsetenv("GRAINLAW_IDLE_MEMORY");
}

TEST(mgis_material, an_environment_variable_goes_before_the_library) {
  setenv("GRAINLAW_MATERIAL_Named", GRAINLAW_TEST_DATA "/rve400.toml", 1);
  const BehaviourLibrary library(std::string(GRAINLAW_BEHAVIOURS) + "/libByHand.so");
  Manager host(library, "Named", "PlaneStrain", 1, cauchy, dsigma_dF);
  EXPECT_EQ(host.integrate(0), 1) << host.message;
  unsetenv("GRAINLAW_MATERIAL_Named");
}

}  // namespace
}  // namespace grainlaw::test
