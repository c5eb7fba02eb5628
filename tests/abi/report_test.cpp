// What a report says of an evaluation that went well.
#include "support.hpp"

#include <string>

namespace grainlaw::test {
namespace {

Material changed(const std::string& solver) {
  return Material::parse(read_text(material_path) + "\n[solver]\n" + solver, data_directory);
}

TEST(report, says_that_a_packing_without_contacts_is_free_of_stress) {
  State state(changed("contacts_lost = \"stress_free\"\n"));
  const Tensor F{1.05, 0, 0, 1.05};
  Tensor P{1, 1, 1, 1};
  const auto found = state.evaluate(F, P);
  ASSERT_TRUE(found);
  EXPECT_EQ(P, (Tensor{}));
  EXPECT_STREQ(found.report.message, "no contact carries a force: the packing is free of stress");
}

// Friction alternates on the way; the increment may end out of balance.
TEST(report, says_where_an_increment_ended_at_the_loose_tolerance) {
  State state(changed("loose_tolerance = 5e-2\n"));
  int told = 0;
  for (int k = 1; k <= 12; ++k) {
    const double strain = 5e-3 * k;
    const Tensor F{1 + 0.6 * strain, 0, 0, 1 - strain};
    Tensor P{};
    Tangent A{};
    const auto found = state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A);
    ASSERT_TRUE(found) << k;
    const std::string message = found.report.message;
    const bool loose = message.starts_with("ended at solver.loose_tolerance; the ");
    EXPECT_TRUE(loose || message.empty()) << message;
    EXPECT_EQ(found.report.tangent_exact, loose || found.report.history_advanced != 0 ? 0 : 1) << k;
    told += loose ? 1 : 0;
    state.commit();
  }
  EXPECT_GE(told, 1);
}

}  // namespace
}  // namespace grainlaw::test
