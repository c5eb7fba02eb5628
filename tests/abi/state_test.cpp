// One integration point: what an evaluation, a commit, a revert, a copy and saved bytes keep.
#include "continue_saved.hpp"
#include "support.hpp"

#include <cfenv>
#include <cmath>
#include <cstdlib>

namespace grainlaw::test {
namespace {

TEST(state, same_F_gives_same_bits) {
  State state(material());
  Tensor P1{}, P2{};
  Tangent A1{}, A2{};
  ASSERT_TRUE(state.evaluate(compressed, P1, GRAINLAW_WANT_TANGENT_EXACT, A1));
  stress(state, further);
  ASSERT_TRUE(state.evaluate(compressed, P2, GRAINLAW_WANT_TANGENT_EXACT, A2));
  EXPECT_TRUE(same_bits(P1, P2));
  EXPECT_TRUE(same_bits(A1, A2));
}

TEST(state, revert_restores_bits) {
  State state(material());
  stress(state, compressed);
  state.commit();
  const auto committed = state.save();
  const auto before = state.measure(GRAINLAW_CAUCHY_STRESS);
  stress(state, further);
  EXPECT_FALSE(same_bits(before, state.measure(GRAINLAW_CAUCHY_STRESS)));
  state.revert();
  EXPECT_TRUE(same_bits(before, state.measure(GRAINLAW_CAUCHY_STRESS)));
  EXPECT_TRUE(same_bits(committed, state.save()));
}

TEST(state, commit_makes_the_trial_the_start_of_the_next_increment) {
  State state(material());
  stress(state, compressed);
  state.commit();
  const Tensor continued = stress(state, further);
  State fresh(material());
  EXPECT_FALSE(same_bits(continued, stress(fresh, further)));
  EXPECT_EQ(grainlaw_commit(state.get()), GRAINLAW_OK);
}

TEST(state, commit_without_a_trial_is_refused) {
  State state(material());
  EXPECT_EQ(grainlaw_commit(state.get()), GRAINLAW_NO_TRIAL);
  stress(state, compressed);
  state.commit();
  EXPECT_EQ(grainlaw_commit(state.get()), GRAINLAW_NO_TRIAL);
  stress(state, further);
  state.revert();
  EXPECT_EQ(grainlaw_commit(state.get()), GRAINLAW_NO_TRIAL);
}

TEST(state, clone_has_the_trial_and_is_independent) {
  State state(material());
  stress(state, compressed);
  State clone(state);
  clone.commit();
  EXPECT_FALSE(same_bits(clone.save(), state.save()));
  state.commit();
  EXPECT_TRUE(same_bits(clone.save(), state.save()));
  EXPECT_TRUE(same_bits(stress(clone, further), stress(state, further)));
}

TEST(state, without_contacts_is_kept_where_the_material_takes_it_as_free_of_stress) {
  std::string text = read_text(material_path);
  text += "[solver]\ncontacts_lost = \"stress_free\"\n";
  const Material made = Material::parse(text.c_str(), data_directory.c_str());
  State state(made);
  const Tensor wide{1.1, 0, 0, 1.1};
  Tensor P{};
  Tangent A{};
  grainlaw_report report = grainlaw_report_default();
  A.fill(1);
  ASSERT_EQ(grainlaw_evaluate(state.get(), wide.data(), GRAINLAW_WANT_TANGENT_EXACT, P.data(),
                              A.data(), &report),
            GRAINLAW_OK);
  EXPECT_EQ(P, Tensor{});
  EXPECT_EQ(A, Tangent{});
  EXPECT_EQ(report.contacts, 0);
  EXPECT_NE(std::string(report.message).find("free of stress"), std::string::npos);
  state.commit();
  const auto saved = state.save();
  State other(made);
  stress(other, compressed);
  ASSERT_EQ(grainlaw_state_load(other.get(), saved.data(), saved.size()), GRAINLAW_OK);
  EXPECT_EQ(other.measure(GRAINLAW_CONTACTS)[0], 0);
  EXPECT_TRUE(same_bits(stress(other, compressed), stress(state, compressed)));
  EXPECT_LT(stress(other, compressed)[3], 0);
  const TemporaryDirectory directory;
  state.revert();
  EXPECT_EQ(grainlaw_state_write_vtk(state.get(), (directory / "free.vtp").string().c_str()),
            GRAINLAW_OK);
  EXPECT_EQ(grainlaw_state_write_packing(state.get(), (directory / "free_").string().c_str()),
            GRAINLAW_OK);
}

TEST(state, outlives_the_handle_of_its_material) {
  grainlaw_material* handle = nullptr;
  ASSERT_EQ(grainlaw_material_load(material_path.c_str(), &handle, nullptr, 0), GRAINLAW_OK);
  grainlaw_state* state = nullptr;
  ASSERT_EQ(grainlaw_state_create(handle, &state), GRAINLAW_OK);
  grainlaw_material_destroy(handle);
  Tensor P{};
  EXPECT_EQ(grainlaw_evaluate(state, compressed.data(), 0, P.data(), nullptr, nullptr),
            GRAINLAW_OK);
  State reference(material());
  EXPECT_TRUE(same_bits(P, stress(reference, compressed)));
  grainlaw_state_destroy(state);
}

TEST(state, loaded_bytes_continue_with_the_same_bits) {
  State state(material());
  stress(state, compressed);
  state.commit();
  const auto bytes = state.save();
  State loaded(material());
  stress(loaded, further);  // a trial that loading drops
  loaded.load(bytes);
  EXPECT_EQ(grainlaw_commit(loaded.get()), GRAINLAW_NO_TRIAL);
  EXPECT_TRUE(same_bits(bytes, loaded.save()));
  EXPECT_TRUE(same_bits(continue_from(state), continue_from(loaded)));
}

TEST(state, bytes_continue_in_a_new_process_with_the_same_bits) {
  State state(material());
  stress(state, compressed);
  state.commit();
  const auto bytes = state.save();
  const TemporaryDirectory directory;
  const auto from = directory / "saved";
  const auto to = directory / "continued";
  write_text(from, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command =
      "'" + self + "' --continue '" + from.string() + "' '" + to.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string continued = read_text(to);
  const auto here = continue_from(state);
  ASSERT_EQ(continued.size(), here.size());
  EXPECT_EQ(std::memcmp(continued.data(), here.data(), here.size()), 0);
}

TEST(state, results_do_not_depend_on_the_floating_point_mode_of_the_host) {
  State state(material());
  const Tensor expected = stress(state, compressed);
  std::fenv_t host;
  std::fegetenv(&host);
  for (const int rounding : {FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO}) {
    std::fesetround(rounding);
    const Tensor found = stress(state, compressed);
    EXPECT_EQ(std::fegetround(), rounding);
    EXPECT_TRUE(same_bits(expected, found));
  }
  std::fesetenv(&host);
#ifdef __GLIBC__
  feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  const Tensor found = stress(state, compressed);
  std::fesetenv(&host);
  EXPECT_TRUE(same_bits(expected, found));
#endif
}

TEST(state, identity_gives_the_stress_of_the_packing) {
  State state(material());
  const Tensor P = stress(state, identity);
  constexpr double pressure = 1e5;  // that the packing was consolidated at [Pa]
  EXPECT_NEAR(P[0], -pressure, 1e-3 * pressure);
  EXPECT_NEAR(P[3], -pressure, 1e-3 * pressure);
}

TEST(state, a_report_tells_what_was_done) {
  State state(material());
  Tensor P{};
  Tangent A{};
  const auto result = state.evaluate(compressed, P, GRAINLAW_WANT_TANGENT_EXACT, A);
  ASSERT_TRUE(result);
  EXPECT_EQ(result.report.size, sizeof(grainlaw_report));
  EXPECT_LE(result.report.residual, 1e-6);
  EXPECT_EQ(result.report.step_ratio, 1);
  EXPECT_GT(result.report.relaxation_steps, 0);
  EXPECT_GE(result.report.subincrements, 1);
  EXPECT_GT(result.report.contacts, 700);
  EXPECT_EQ(result.report.tangent_exact, 1);
  EXPECT_STREQ(result.report.message, "");
}

TEST(state, a_smaller_known_report_is_filled_to_its_size) {
  // Of version 0.1 the fields, without the padding at the end.
  constexpr std::size_t size = offsetof(grainlaw_report, message) + 256;
  grainlaw_report report;
  std::memset(&report, 0x5a, sizeof report);
  report.size = size;
  State state(material());
  ASSERT_EQ(grainlaw_evaluate(state.get(), compressed.data(), 0, nullptr, nullptr, &report),
            GRAINLAW_OK);
  EXPECT_EQ(report.size, size);
  EXPECT_GT(report.contacts, 0);
  EXPECT_STREQ(report.message, "");
  const auto* bytes = reinterpret_cast<const unsigned char*>(&report);
  for (std::size_t k = size; k < sizeof report; ++k) EXPECT_EQ(bytes[k], 0x5a);
}

TEST(state, a_written_packing_starts_at_the_stress_it_was_written_with) {
  constexpr double tolerance = 1e-5 * 1e5;  // of the pressure [Pa]
  for (const std::string boundary : {"periodic-cell", "frame-p"}) {
    std::string text = read_text(material_path) + "[boundary]\ntype = \"" + boundary + "\"\n";
    State state(Material::parse(text, data_directory));
    stress(state, compressed);
    const TemporaryDirectory directory;
    state.write_packing((directory / "here").string());
    for (const std::string old = "rve400_"; text.find(old) != std::string::npos;)
      text.replace(text.find(old), old.size(), "here_");
    State restarted(Material::parse(text, directory.string()));
    const auto expected = state.measure(GRAINLAW_CAUCHY_STRESS);
    const auto found = restarted.measure(GRAINLAW_CAUCHY_STRESS);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(found[k], expected[k], tolerance) << boundary;
    EXPECT_NEAR(restarted.measure(GRAINLAW_VOID_RATIO)[0], state.measure(GRAINLAW_VOID_RATIO)[0],
                1e-9);
  }
}

TEST(state, a_vtk_file_is_written) {
  State state(material());
  const TemporaryDirectory directory;
  state.write_vtk((directory / "state.vtp").string());
  EXPECT_NE(read_text(directory / "state.vtp").find("PolyData"), std::string::npos);
}

TEST(state, every_measure_can_be_asked) {
  State state(material());
#define GRAINLAW_X(name, value, count, text) \
  for (const double number : state.measure(name)) EXPECT_TRUE(std::isfinite(number)) << text;
  GRAINLAW_MEASURE_LIST(GRAINLAW_X)
#undef GRAINLAW_X
  EXPECT_EQ(state.measure(GRAINLAW_PARTICLES), std::vector{400.0});
  EXPECT_EQ(state.measure(GRAINLAW_FABRIC).size(), 4U);
}

TEST(texts, every_status_has_one) {
#define GRAINLAW_X(name, value, text) EXPECT_STREQ(grainlaw_status_text(name), text);
  GRAINLAW_STATUS_LIST(GRAINLAW_X)
#undef GRAINLAW_X
  EXPECT_STREQ(grainlaw_status_text(static_cast<grainlaw_status>(-16)), "unknown status");
  EXPECT_STREQ(grainlaw_version(), "0.1.0");
}

}  // namespace
}  // namespace grainlaw::test
