// Calls of a set that are wrong: told, and nothing changed.
#include "points_support.hpp"

#include <cstdint>
#include <limits>
#include <random>

namespace grainlaw::test {
namespace {

using Bytes = std::vector<std::byte>;

std::string unknown_want(unsigned want) {
  return "want is " + std::to_string(want) +
         ", expected 0 or one of GRAINLAW_WANT_TANGENT_*: 1, 2 or 4";
}

// Evaluated and not committed, so that a change would be seen.
class bad_points : public testing::Test {
 protected:
  bad_points() { evaluate(set_, 2); }
  void TearDown() override {
    EXPECT_TRUE(same_bits(set_.save(), before_));
    EXPECT_EQ(set_.measure(GRAINLAW_DEFORMATION_GRADIENT), deformations());
    EXPECT_EQ(grainlaw_points_commit(set_.get()), GRAINLAW_OK);
  }
  void expect_not_loaded(std::span<const std::byte> bytes, grainlaw_status expected,
                         const std::string& what) {
    char message[256] = "";
    expect_refused(
        grainlaw_points_load(set_.get(), bytes.data(), bytes.size(), message, sizeof message),
        expected, what);
    EXPECT_STRNE(message, "") << what;
  }
  // What another set of two points saves, after a commit.
  static Bytes saved_pair(const Material& of = material(), double shortening = 1e-3) {
    Points pair(of, 2);
    const std::array<double, 8> F{1, 0, 0, 1, 1, 0, 0, 1 - shortening};
    std::array<double, 8> P;
    EXPECT_TRUE(pair.evaluate(F, P));
    pair.commit();
    return pair.save();
  }

  Points set_ = make_set();
  Bytes before_ = set_.save();
};

TEST_F(bad_points, null_pointers_are_refused) {
  const auto refused = [](grainlaw_status found, const char* what) {
    expect_refused(found, GRAINLAW_NULL_POINTER, what);
  };
  grainlaw_points* created = set_.get();
  std::size_t size = 0;
  double value = 0;
  refused(grainlaw_points_create(nullptr, 1, &created), "create material");
  EXPECT_EQ(created, nullptr);
  refused(grainlaw_points_create(material().get(), 1, nullptr), "create out");
  refused(grainlaw_points_clone(nullptr, &created), "clone set");
  refused(grainlaw_points_clone(set_.get(), nullptr), "clone out");
  refused(
      grainlaw_points_evaluate(nullptr, &value, 0, nullptr, nullptr, nullptr, nullptr, 1, nullptr),
      "evaluate set");
  refused(grainlaw_points_commit(nullptr), "commit");
  refused(grainlaw_points_set_time_step(nullptr, 1), "set_time_step");
  refused(grainlaw_points_revert(nullptr), "revert");
  refused(grainlaw_points_save(nullptr, nullptr, &size), "save set");
  refused(grainlaw_points_save(set_.get(), nullptr, nullptr), "save size");
  refused(grainlaw_points_load(nullptr, &value, 8, nullptr, 0), "load set");
  refused(grainlaw_points_load(set_.get(), nullptr, 8, nullptr, 0), "load bytes");
  refused(grainlaw_points_measure(nullptr, GRAINLAW_VOLUME, &value, &size), "measure set");
  refused(grainlaw_points_measure(set_.get(), GRAINLAW_VOLUME, &value, nullptr), "measure count");
  EXPECT_EQ(grainlaw_points_size(nullptr), 0U);
  EXPECT_EQ(grainlaw_points_state(nullptr, 0), nullptr);
  EXPECT_EQ(grainlaw_points_state(set_.get(), points), nullptr);
  EXPECT_EQ(grainlaw_points_state(set_.get(), SIZE_MAX), nullptr);
  grainlaw_points_destroy(nullptr);
}

TEST_F(bad_points, an_unknown_tangent_of_a_state_is_told) {
  State state(material());
  grainlaw_report report = grainlaw_report_default();
  EXPECT_EQ(grainlaw_evaluate(state.get(), identity.data(), 3, nullptr, nullptr, &report),
            GRAINLAW_BAD_ARGUMENT);
  EXPECT_EQ(report.message, unknown_want(3));
}

TEST_F(bad_points, a_handle_of_another_kind_or_dead_is_told) {
  alignas(16) std::array<std::uint64_t, 64> dead{};
  State state(material());
  for (void* wrong : {static_cast<void*>(dead.data()), static_cast<void*>(state.get())}) {
    auto* handle = static_cast<grainlaw_points*>(wrong);
    const auto refused = [](grainlaw_status found, const char* what) {
      expect_refused(found, GRAINLAW_BAD_HANDLE, what);
    };
    grainlaw_points* created = nullptr;
    std::size_t size = 0;
    double value = 0;
    refused(grainlaw_points_clone(handle, &created), "clone");
    refused(
        grainlaw_points_evaluate(handle, &value, 0, nullptr, nullptr, nullptr, nullptr, 1, nullptr),
        "evaluate");
    refused(grainlaw_points_commit(handle), "commit");
    refused(grainlaw_points_set_time_step(handle, 1), "set_time_step");
    refused(grainlaw_points_revert(handle), "revert");
    refused(grainlaw_points_save(handle, nullptr, &size), "save");
    refused(grainlaw_points_load(handle, &value, sizeof value, nullptr, 0), "load");
    refused(grainlaw_points_measure(handle, GRAINLAW_VOLUME, &value, &size), "measure");
    EXPECT_EQ(grainlaw_points_size(handle), 0U);
    EXPECT_EQ(grainlaw_points_state(handle, 0), nullptr);
    grainlaw_points_destroy(handle);
  }
  grainlaw_points* created = nullptr;
  expect_refused(
      grainlaw_points_create(reinterpret_cast<grainlaw_material*>(dead.data()), 1, &created),
      GRAINLAW_BAD_HANDLE, "create");
}

TEST_F(bad_points, a_lent_state_cannot_be_changed_or_destroyed) {
  auto* const lent = const_cast<grainlaw_state*>(set_.state(0));
  const auto refused = [](grainlaw_status found, const char* what) {
    expect_refused(found, GRAINLAW_BAD_HANDLE, what);
  };
  const auto bytes = save_one(lent);
  grainlaw_status status = GRAINLAW_OK;
  refused(grainlaw_evaluate(lent, identity.data(), 0, nullptr, nullptr, nullptr), "evaluate");
  refused(
      grainlaw_evaluate_batch(1, &lent, identity.data(), 0, nullptr, nullptr, &status, nullptr, 1),
      "batch");
  EXPECT_EQ(status, GRAINLAW_BAD_HANDLE);
  refused(grainlaw_commit(lent), "commit");
  refused(grainlaw_revert(lent), "revert");
  refused(grainlaw_state_load(lent, bytes.data(), bytes.size()), "load");
  grainlaw_state_destroy(lent);
}

TEST_F(bad_points, an_evaluation_is_refused_before_any_point_is_touched) {
  const auto F = deformations();
  Result found;
  grainlaw_summary summary = grainlaw_summary_default();
  const auto call = [&](const double* deformation, unsigned want) {
    found.status.assign(points, GRAINLAW_OK);
    return grainlaw_points_evaluate(set_.get(), deformation, want, found.P.data(), found.A.data(),
                                    found.status.data(), found.report.data(), 2, &summary);
  };
  const auto refused = [&](grainlaw_status status, grainlaw_status expected,
                           const std::string& what) {
    expect_refused(status, expected, what);
    EXPECT_EQ(found.status, std::vector(points, expected)) << what;
    EXPECT_EQ(found.P, std::vector<double>(4 * points)) << what;
    EXPECT_EQ(summary.failed, 0) << what;
    EXPECT_EQ(summary.first_failed, -1) << what;
    EXPECT_EQ(summary.step_ratio, 0) << what;
    EXPECT_EQ(summary.message, what);
  };
  refused(call(nullptr, 0), GRAINLAW_NULL_POINTER, "F is null");
  for (const unsigned want : {3U, 5U, 6U, 7U, 8U, ~0U})
    refused(call(F.data(), want), GRAINLAW_BAD_ARGUMENT, unknown_want(want));
  found.report[3].size = 8;
  refused(call(F.data(), 0), GRAINLAW_BAD_REPORT, grainlaw_status_text(GRAINLAW_BAD_REPORT));
  found.report[3].size = sizeof(grainlaw_report);
  for (const std::size_t size :
       {std::size_t{0}, offsetof(grainlaw_summary, rank) - 8, sizeof summary + 8}) {
    summary.size = size;
    const grainlaw_summary kept = summary;
    expect_refused(call(F.data(), 0), GRAINLAW_BAD_REPORT, "a summary of another size");
    EXPECT_EQ(std::memcmp(&kept, &summary, sizeof kept), 0);
    EXPECT_EQ(found.status, std::vector(points, GRAINLAW_OK));
  }
}

TEST_F(bad_points, more_of_them_than_there_can_be_are_told) {
  for (const std::size_t n : {SIZE_MAX, SIZE_MAX / 8}) {
    grainlaw_points* created = set_.get();
    expect_refused(grainlaw_points_create(material().get(), n, &created), GRAINLAW_OUT_OF_MEMORY,
                   std::to_string(n));
    EXPECT_EQ(created, nullptr);
  }
}

TEST_F(bad_points, an_unknown_measure_or_a_short_buffer_is_refused) {
  std::vector<double> values(4 * points, 7);
  for (const int what : {99, 125, 1031}) {
    std::size_t count = values.size();
    expect_refused(grainlaw_points_measure(set_.get(), static_cast<grainlaw_measure>(what),
                                           values.data(), &count),
                   GRAINLAW_BAD_ARGUMENT, std::to_string(what));
  }
  for (const std::size_t capacity : {std::size_t{0}, std::size_t{4}, 4 * points - 1}) {
    std::size_t count = capacity;
    expect_refused(grainlaw_points_measure(set_.get(), GRAINLAW_FABRIC, values.data(), &count),
                   GRAINLAW_BUFFER_TOO_SMALL, std::to_string(capacity));
    EXPECT_EQ(count, capacity);
  }
  EXPECT_EQ(values, std::vector<double>(4 * points, 7));
  std::vector<std::byte> bytes(before_.size(), std::byte{7});
  std::size_t size = bytes.size() - 1;
  expect_refused(grainlaw_points_save(set_.get(), bytes.data(), &size), GRAINLAW_BUFFER_TOO_SMALL,
                 "save");
  EXPECT_EQ(bytes, std::vector<std::byte>(before_.size(), std::byte{7}));
}

TEST_F(bad_points, damaged_bytes_are_told) {
  Points other = make_set();
  evaluate(other, 2);
  other.commit();
  const Bytes saved = other.save();
  std::minstd_rand random(1);
  for (std::size_t k = 0; k < saved.size(); k += k < 256 ? 1 : 997) {
    Bytes damaged = saved;
    damaged[k] ^= static_cast<std::byte>(1 + random() % 255);
    expect_not_loaded(damaged, GRAINLAW_BAD_BYTES, "byte " + std::to_string(k));
  }
  for (std::size_t size = 0; size < saved.size(); size += size < 256 ? 1 : 997)
    expect_not_loaded(std::span(saved).first(size), GRAINLAW_BAD_BYTES,
                      "length " + std::to_string(size));
  for (const std::size_t more : {1U, 8U, 1000U}) {
    Bytes longer = saved;
    longer.insert(longer.end(), more, std::byte{0});
    expect_not_loaded(longer, GRAINLAW_BAD_BYTES, "longer by " + std::to_string(more));
  }
}

TEST_F(bad_points, bytes_of_something_else_are_told) {
  expect_not_loaded(save_one(set_.state(0)), GRAINLAW_BAD_BYTES, "one state");
  expect_not_loaded(saved_pair(), GRAINLAW_BAD_ARGUMENT, "two points");
  const Bytes pair = saved_pair();
  EXPECT_EQ(grainlaw_state_load(State(material()).get(), pair.data(), pair.size()),
            GRAINLAW_BAD_BYTES);
}

TEST_F(bad_points, bytes_of_another_material_are_told_with_the_point) {
  std::string text = read_text(material_path);
  text.replace(text.find("ratio = 0.8"), 11, "ratio = 0.7");
  Points other(Material::parse(text, data_directory), 2);
  const auto before = other.save();
  const Bytes saved = saved_pair();
  char message[256] = "";
  expect_refused(
      grainlaw_points_load(other.get(), saved.data(), saved.size(), message, sizeof message),
      GRAINLAW_WRONG_MATERIAL, "another ratio");
  EXPECT_STREQ(message, "point 0: saved state: of another material");
  EXPECT_TRUE(same_bits(other.save(), before));
}

}  // namespace
}  // namespace grainlaw::test
