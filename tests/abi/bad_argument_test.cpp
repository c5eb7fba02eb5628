// Null pointers, dead handles, impossible deformations, unknown reports: told, and nothing changed.
#include "support.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

namespace grainlaw::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(bad_pointer, null_is_refused_by_every_function) {
  const auto refused = [](grainlaw_status found, const char* what) {
    expect_refused(found, GRAINLAW_NULL_POINTER, what);
  };
  char message[64] = "untouched";
  grainlaw_material* made = nullptr;
  refused(grainlaw_material_load(nullptr, &made, message, sizeof message), "load path");
  EXPECT_STREQ(message, grainlaw_status_text(GRAINLAW_NULL_POINTER));
  refused(grainlaw_material_load(material_path.c_str(), nullptr, message, sizeof message), "out");
  refused(grainlaw_material_parse(nullptr, nullptr, &made, nullptr, 0), "parse text");
  refused(grainlaw_material_parse("", nullptr, nullptr, nullptr, 0), "parse out");
  refused(grainlaw_material_keys(message, nullptr), "keys size");
  EXPECT_EQ(grainlaw_material_dimension(nullptr), 0);
  grainlaw_material_destroy(nullptr);

  State state(material());
  grainlaw_state* created = nullptr;
  refused(grainlaw_state_create(nullptr, &created), "create material");
  refused(grainlaw_state_create(material().get(), nullptr), "create out");
  refused(grainlaw_state_clone(nullptr, &created), "clone state");
  refused(grainlaw_state_clone(state.get(), nullptr), "clone out");
  grainlaw_state_destroy(nullptr);

  const double* F = compressed.data();
  refused(grainlaw_evaluate(nullptr, F, 0, nullptr, nullptr, nullptr), "evaluate state");
  refused(grainlaw_evaluate(state.get(), nullptr, 0, nullptr, nullptr, nullptr), "evaluate F");
  refused(grainlaw_commit(nullptr), "commit");
  refused(grainlaw_state_set_time_step(nullptr, 1), "set_time_step");
  refused(grainlaw_revert(nullptr), "revert");

  std::size_t size = 0;
  double value = 0;
  refused(grainlaw_state_save(nullptr, nullptr, &size), "save state");
  refused(grainlaw_state_save(state.get(), nullptr, nullptr), "save size");
  refused(grainlaw_state_load(nullptr, &value, sizeof value), "load state");
  refused(grainlaw_state_load(state.get(), nullptr, 0), "load bytes");
  refused(grainlaw_state_measure(nullptr, GRAINLAW_VOLUME, &value, &size), "measure state");
  refused(grainlaw_state_measure(state.get(), GRAINLAW_VOLUME, &value, nullptr), "measure count");
  refused(grainlaw_state_write_vtk(nullptr, "x"), "vtk state");
  refused(grainlaw_state_write_vtk(state.get(), nullptr), "vtk path");
  refused(grainlaw_state_write_packing(nullptr, "x"), "packing state");
  refused(grainlaw_state_write_packing(state.get(), nullptr), "packing prefix");
}

TEST(bad_handle, of_the_other_kind_or_dead_is_told) {
  // Memory that once was a handle, and a handle of the other kind.
  alignas(16) std::array<std::uint64_t, 64> dead{};
  State state(material());
  for (void* wrong : {static_cast<void*>(dead.data()), static_cast<void*>(state.get())}) {
    auto* handle = static_cast<grainlaw_material*>(wrong);
    grainlaw_state* created = nullptr;
    EXPECT_EQ(grainlaw_material_dimension(handle), 0);
    expect_refused(grainlaw_state_create(handle, &created), GRAINLAW_BAD_HANDLE, "create");
    EXPECT_EQ(created, nullptr);
    grainlaw_material_destroy(handle);
  }
  auto* of_material = const_cast<grainlaw_material*>(material().get());
  for (void* wrong : {static_cast<void*>(dead.data()), static_cast<void*>(of_material)}) {
    auto* handle = static_cast<grainlaw_state*>(wrong);
    const auto refused = [](grainlaw_status found, const char* what) {
      expect_refused(found, GRAINLAW_BAD_HANDLE, what);
    };
    grainlaw_state* created = nullptr;
    std::size_t size = 0;
    double value = 0;
    refused(grainlaw_state_clone(handle, &created), "clone");
    refused(grainlaw_evaluate(handle, compressed.data(), 0, nullptr, nullptr, nullptr), "evaluate");
    refused(grainlaw_commit(handle), "commit");
    refused(grainlaw_state_set_time_step(handle, 1), "set_time_step");
    refused(grainlaw_revert(handle), "revert");
    refused(grainlaw_state_save(handle, nullptr, &size), "save");
    refused(grainlaw_state_load(handle, &value, sizeof value), "load");
    refused(grainlaw_state_measure(handle, GRAINLAW_VOLUME, &value, &size), "measure");
    refused(grainlaw_state_write_vtk(handle, "x"), "vtk");
    refused(grainlaw_state_write_packing(handle, "x"), "packing");
    grainlaw_state_destroy(handle);
  }
  EXPECT_TRUE(std::isfinite(stress(state, compressed)[0]));
}

// Evaluates F in a state that has a trial; expects a refusal that leaves all but the trial alone.
void expect_bad_deformation(const Tensor& F, grainlaw_status expected, const std::string& what) {
  static State state(material());
  const auto committed = state.save();
  stress(state, compressed);
  Tensor P{7, 7, 7, 7};
  Tangent A;
  A.fill(7);
  grainlaw_report report = grainlaw_report_default();
  const auto status = grainlaw_evaluate(state.get(), F.data(), GRAINLAW_WANT_TANGENT_EXACT,
                                        P.data(), A.data(), &report);
  expect_refused(status, expected, what);
  EXPECT_STRNE(report.message, "") << what;
  EXPECT_EQ(report.step_ratio > 0, expected > GRAINLAW_OK) << what;
  EXPECT_LT(report.step_ratio, 1) << what;
  EXPECT_EQ(P, (Tensor{7, 7, 7, 7})) << what;
  for (const double a : A) EXPECT_EQ(a, 7) << what;
  EXPECT_TRUE(same_bits(committed, state.save())) << what;
  EXPECT_EQ(grainlaw_commit(state.get()), GRAINLAW_NO_TRIAL) << what;
}

TEST(bad_deformation, nan_or_infinity_in_any_entry_is_refused) {
  for (std::size_t k = 0; k < 4; ++k)
    for (const double entry : {nan, -nan, infinity, -infinity}) {
      Tensor F = compressed;
      F[k] = entry;
      expect_bad_deformation(F, GRAINLAW_NOT_FINITE, "entry " + std::to_string(k));
    }
}

TEST(bad_deformation, an_inverted_element_is_recoverable) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  for (const Tensor& F : {Tensor{-1, 0, 0, 1}, Tensor{0, 0, 0, 0}, Tensor{1, 1, 1, 1},
                          Tensor{0, 1, 1, 0}, Tensor{1, 2, 1, 1}, Tensor{tiny, 0, 0, tiny}})
    expect_bad_deformation(F, GRAINLAW_INVERTED, "det F <= 0");
}

TEST(bad_deformation, a_huge_stretch_is_recoverable) {
  for (const double stretch : {1.5, 1e3, 1e6, 1e150, 1e300})
    for (const Tensor& F :
         {Tensor{stretch, 0, 0, 1}, Tensor{1, 0, 0, stretch}, Tensor{stretch, 0, 0, stretch},
          Tensor{1, stretch, 0, 1}, Tensor{1 / stretch, 0, 0, 1}})
      expect_bad_deformation(F, GRAINLAW_STEP_TOO_LARGE, "stretch " + std::to_string(stretch));
}

TEST(bad_report, of_unknown_size_is_refused) {
  State state(material());
  const auto committed = state.save();
  stress(state, compressed);
  // Reports grow at their end only: up to the message they had it all from the first.
  constexpr std::size_t first_report_size =
      offsetof(grainlaw_report, message) + sizeof(grainlaw_report::message);
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, std::size_t{8}, first_report_size - 1,
        sizeof(grainlaw_report) + 1, 2 * sizeof(grainlaw_report), SIZE_MAX}) {
    grainlaw_report report;
    std::memset(&report, 0x5a, sizeof report);
    const grainlaw_report before = [&] {
      report.size = size;
      return report;
    }();
    expect_refused(grainlaw_evaluate(state.get(), further.data(), 0, nullptr, nullptr, &report),
                   GRAINLAW_BAD_REPORT, std::to_string(size));
    EXPECT_EQ(std::memcmp(&before, &report, sizeof report), 0);
  }
  EXPECT_TRUE(same_bits(committed, state.save()));
}

TEST(bad_argument, more_than_one_tangent_or_an_unknown_one_is_refused) {
  State state(material());
  for (unsigned want = 0; want < 64; ++want) {
    if (want == 0 || want == 1 || want == 2 || want == 4) continue;
    expect_refused(
        grainlaw_evaluate(state.get(), compressed.data(), want, nullptr, nullptr, nullptr),
        GRAINLAW_BAD_ARGUMENT, std::to_string(want));
  }
}

TEST(bad_argument, an_unknown_measure_or_a_short_buffer_is_refused) {
  State state(material());
  double value[4] = {7, 7, 7, 7};
  for (const int what : {99, 125, 1031}) {
    std::size_t count = 4;
    expect_refused(
        grainlaw_state_measure(state.get(), static_cast<grainlaw_measure>(what), value, &count),
        GRAINLAW_BAD_ARGUMENT, std::to_string(what));
  }
  for (std::size_t count = 0; count < 4; ++count) {
    std::size_t capacity = count;
    expect_refused(grainlaw_state_measure(state.get(), GRAINLAW_FABRIC, value, &capacity),
                   GRAINLAW_BUFFER_TOO_SMALL, std::to_string(count));
    EXPECT_EQ(capacity, count);
    EXPECT_EQ(value[0], 7);
  }
}

TEST(bad_file, that_cannot_be_written_is_told) {
  State state(material());
  for (const char* path : {"", "/", "/no/such/directory/x", "/dev/null/x"}) {
    expect_refused(grainlaw_state_write_vtk(state.get(), path), GRAINLAW_FILE_ERROR, path);
    if (std::string(path).size() > 1)
      expect_refused(grainlaw_state_write_packing(state.get(), path), GRAINLAW_FILE_ERROR, path);
  }
}

}  // namespace
}  // namespace grainlaw::test
