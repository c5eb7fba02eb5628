// Points of a set by number: bytes, answers without an increment, parts of a set, copies, their
// number.
#include "points_support.hpp"
#include "seal.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace grainlaw::test {
namespace {

using namespace std::string_literals;

using Numbers = std::vector<std::size_t>;

Points committed_set() {
  Points set = make_set();
  evaluate(set, 2);
  set.commit();
  return set;
}

std::vector<double> later() {
  auto F = deformations();
  for (std::size_t k = 0; k < points; ++k) F[4 * k + 3] -= 1e-3;
  return F;
}

const Material& law_in_time() {
  static const Material instance = Material::parse(
      read_text(material_path) + "[solver]\nviscous_number = 1e-3\n", data_directory);
  return instance;
}

// F of these points.
std::vector<double> rows(const std::vector<double>& F, const Numbers& which) {
  std::vector<double> found;
  for (const std::size_t k : which)
    found.insert(found.end(), F.begin() + static_cast<long>(4 * k),
                 F.begin() + static_cast<long>(4 * k + 4));
  return found;
}

TEST(some_points, moved_by_bytes_continue_with_the_same_bits) {
  Points set = committed_set();
  const Numbers from{6, 1, 3}, to{0, 5, 2};
  Points other = make_set();
  evaluate(other, 2);
  other.load_some(to, set.save_some(from));
  EXPECT_EQ(grainlaw_points_commit(other.get()), GRAINLAW_NO_TRIAL);  // those loaded have none
  Points copied = make_set();
  copied.clone_some(to, set, from);
  for (std::size_t k = 0; k < from.size(); ++k) {
    EXPECT_TRUE(same_bits(save_one(other.state(to[k])), save_one(set.state(from[k]))));
    EXPECT_TRUE(same_bits(save_one(copied.state(to[k])), save_one(set.state(from[k]))));
  }
  const std::vector<double> F = rows(later(), from);
  std::vector<double> P(F.size()), expected(F.size());
  ASSERT_TRUE(set.evaluate_some(from, F, expected));
  for (Points* each : {&other, &copied}) {
    ASSERT_TRUE(each->evaluate_some(to, F, P));
    EXPECT_TRUE(same_bits(P, expected));
  }
}

TEST(some_points, have_the_bytes_of_a_state_alone_and_of_their_set) {
  Points set = committed_set();
  for (std::size_t k = 0; k < points; ++k) {
    const auto one = set.save_some(Numbers{k});
    State alone(material());
    alone.load(one.bytes);  // a tangent behind it is left out
    EXPECT_TRUE(same_bits(alone.save(), save_one(set.state(k))));
    Points single(material(), 1);
    single.load(one.bytes);
    EXPECT_TRUE(same_bits(single.save_some(Numbers{0}).bytes, one.bytes));
    single.load_some(Numbers{0}, {alone.save(), {0, alone.save().size()}});
    EXPECT_TRUE(same_bits(save_one(single.state(0)), alone.save()));
  }
}

// A set without tangents as version 1 wrote it: the same bytes but for the number.
TEST(some_points, bytes_of_sets_without_tangents_are_still_read) {
  Points set = make_set();
  std::vector<double> P(4 * points);
  ASSERT_TRUE(set.evaluate(deformations(), P));
  set.commit();
  const auto saved = set.save();
  auto old = saved;
  old[8] = std::byte{1};
  seal(old);
  Points loaded = make_set();
  loaded.load(old);
  EXPECT_TRUE(same_bits(loaded.save(), saved));
  old[8] = std::byte{3};
  seal(old);
  EXPECT_EQ(grainlaw_points_load(loaded.get(), old.data(), old.size(), nullptr, 0),
            GRAINLAW_WRONG_VERSION);
}

// With drag another evaluation at the committed F is one more increment, with another stress.
TEST(some_points, answer_with_the_bits_that_were_committed_after_a_restart_with_drag) {
  Points set(law_in_time(), points);
  const Result first = evaluate(set, 2);
  set.commit();
  Points loaded(law_in_time(), points);
  loaded.load(set.save());
  Points moved(law_in_time(), points);
  Numbers all(points);
  std::iota(all.begin(), all.end(), std::size_t{0});
  moved.load_some(all, set.save_some(all));
  for (Points* each : {&set, &loaded, &moved}) {
    const auto before = each->save();
    Result found;
    ASSERT_TRUE(each->answer(found.P, GRAINLAW_WANT_TANGENT_EXACT, found.A));
    EXPECT_TRUE(same_bits(found.P, first.P));
    EXPECT_TRUE(same_bits(found.A, first.A));
    EXPECT_TRUE(same_bits(each->save(), before));
    EXPECT_EQ(grainlaw_points_commit(each->get()), GRAINLAW_NO_TRIAL);
  }
  EXPECT_FALSE(same_bits(evaluate(loaded, 2).P, first.P));
}

TEST(some_points, answer_at_the_start_and_with_another_tangent_without_changing_a_trial) {
  Points set = make_set();
  Result found;
  ASSERT_TRUE(set.answer(found.P, GRAINLAW_WANT_TANGENT_EXACT, found.A, 2));
  State one(material());
  const Tensor P = stress(one, identity);
  Tangent A{};
  Tensor again{};
  ASSERT_TRUE(one.evaluate(identity, again, GRAINLAW_WANT_TANGENT_EXACT, A));
  for (std::size_t m = 0; m < 4; ++m) EXPECT_NEAR(found.P[m], P[m], 1e-3);  // Pa
  EXPECT_TRUE(std::equal(A.begin(), A.end(), found.A.begin()));
  evaluate(set, 2);
  ASSERT_TRUE(set.answer({}, GRAINLAW_WANT_TANGENT_ELASTIC, found.A));
  EXPECT_NE(found.A[0], A[0]);
  set.commit();
}

TEST(some_points, evaluate_a_part_with_gaps_and_leave_the_others) {
  Points set = make_set();
  const Result expected = evaluate(set, 2);
  set.revert();
  const Numbers which{5, 0, 2};
  constexpr std::size_t F_stride = 6, P_stride = 5, A_stride = 20;
  std::vector<double> F(F_stride * 3, NAN), P(P_stride * 3, 7), A(A_stride * 3, 7);
  for (std::size_t k = 0; k < 3; ++k)
    std::copy_n(deformations().begin() + static_cast<long>(4 * which[k]), 4,
                F.begin() + static_cast<long>(F_stride * k));
  grainlaw_summary summary = grainlaw_summary_default();
  ASSERT_EQ(grainlaw_points_evaluate_some(set.get(), 3, which.data(), F.data(), F_stride,
                                          GRAINLAW_WANT_TANGENT_EXACT, P.data(), P_stride, A.data(),
                                          A_stride, nullptr, nullptr, 2, &summary),
            GRAINLAW_OK);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t m = 0; m < P_stride; ++m)
      EXPECT_EQ(P[P_stride * k + m], m < 4 ? expected.P[4 * which[k] + m] : 7);
    for (std::size_t m = 0; m < A_stride; ++m)
      EXPECT_EQ(A[A_stride * k + m], m < 16 ? expected.A[16 * which[k] + m] : 7);
  }
  EXPECT_EQ(grainlaw_points_commit(set.get()), GRAINLAW_NO_TRIAL);
  const Numbers others{1, 3, 4, 6, 7};
  std::vector<double> rest = rows(deformations(), others);
  ASSERT_EQ(others.size() + which.size(), points);
  std::vector<double> unused(rest.size());
  ASSERT_TRUE(set.evaluate_some(others, rest, unused));
  set.commit();
}

TEST(some_points, name_the_failed_one_by_its_number_in_the_set) {
  Points set = make_set();
  const Numbers which{6, 4};
  std::vector<double> F{1, 0, 0, 0.999, -1, 0, 0, 1}, P(8);
  const auto found = set.evaluate_some(which, F, P);
  EXPECT_EQ(found.status, GRAINLAW_INVERTED);
  EXPECT_EQ(found.summary.first_failed, 4);
  EXPECT_EQ(found.message().rfind("point 4: det F", 0), 0U);
}

TEST(some_points, tell_the_time_that_they_took) {
  Points set = make_set();
  EXPECT_EQ(set.cost(), std::vector<double>(points));
  evaluate(set, 1);
  for (const double seconds : set.cost()) {
    EXPECT_GT(seconds, 1e-5);
    EXPECT_LT(seconds, 1);
  }
  EXPECT_EQ(Points(set).cost(), set.cost());
}

TEST(some_points, become_more_and_fewer) {
  Points set = committed_set();
  const auto before = set.save();
  const auto* const borrowed = set.state(3);
  set.resize(points + 3);
  EXPECT_EQ(set.size(), points + 3);
  EXPECT_EQ(set.state(3), borrowed);
  EXPECT_TRUE(same_bits(save_one(set.state(points + 2)), State(material()).save()));
  const Material bonded = Material::load(data_directory + "/bonded100.toml");
  set.resize(points + 4, bonded);
  EXPECT_TRUE(same_bits(save_one(set.state(points + 3)), State(bonded).save()));
  std::vector<double> F, P(4 * set.size());
  for (std::size_t k = 0; k < set.size(); ++k) F.insert(F.end(), identity.begin(), identity.end());
  F[4 * (points + 3) + 1] = 1e-4;
  std::copy_n(deformations().begin(), 4 * points, F.begin());
  ASSERT_TRUE(set.evaluate(F, P));
  set.commit();
  set.resize(points);
  set.load(before);
  EXPECT_TRUE(same_bits(set.save(), before));
  set.resize(0);
  EXPECT_EQ(set.size(), 0U);
}

TEST(some_points, are_copied_within_a_set_from_what_they_were) {
  Points set = committed_set();
  const auto bytes = [&](std::size_t k) { return save_one(set.state(k)); };
  const auto first = bytes(0), second = bytes(1);
  set.clone_some(Numbers{0, 1}, set, Numbers{1, 0});
  EXPECT_TRUE(same_bits(bytes(0), second));
  EXPECT_TRUE(same_bits(bytes(1), first));
  Points trial = make_set();
  evaluate(trial, 2);
  Points copy = make_set();
  Numbers all(points);
  std::iota(all.begin(), all.end(), std::size_t{0});
  copy.clone_some(all, trial, all);
  copy.commit();  // the trials came along
}

class bad_some_points : public testing::Test {
 protected:
  bad_some_points() { evaluate(set_, 2); }
  void TearDown() override {
    EXPECT_TRUE(same_bits(set_.save(), before_));
    EXPECT_EQ(grainlaw_points_commit(set_.get()), GRAINLAW_OK);
  }
  Points set_ = make_set();
  std::vector<std::byte> before_ = set_.save();
};

TEST_F(bad_some_points, numbers_outside_or_twice_are_refused) {
  const auto F = deformations();
  const std::string size = std::to_string(points);
  const std::vector<std::pair<Numbers, std::string>> wrong{
      {{0, points}, "point " + size + ", expected numbers below " + size},
      {{SIZE_MAX, 1}, "point " + std::to_string(SIZE_MAX) + ", expected numbers below " + size},
      {{2, 2}, "a point comes twice"}};
  for (const auto& [which, fault] : wrong) {
    std::vector<double> P(8, 7);
    std::array<grainlaw_status, 2> status{};
    grainlaw_summary summary = grainlaw_summary_default();
    expect_refused(
        grainlaw_points_evaluate_some(set_.get(), 2, which.data(), F.data(), 0, 0, P.data(), 0,
                                      nullptr, 0, status.data(), nullptr, 1, &summary),
        GRAINLAW_BAD_ARGUMENT, "evaluate");
    EXPECT_EQ(status[1], GRAINLAW_BAD_ARGUMENT);
    EXPECT_EQ(summary.message, fault);
    EXPECT_EQ(P, std::vector<double>(8, 7));
    const auto good = set_.save_some(Numbers{0, 1});
    std::array<char, 256> message{};
    expect_refused(grainlaw_points_load_some(set_.get(), 2, which.data(), good.bytes.data(),
                                             good.offsets.data(), message.data(), message.size()),
                   GRAINLAW_BAD_ARGUMENT, "load");
    EXPECT_EQ(message.data(), fault);
    const Numbers source{0, 1};
    expect_refused(
        grainlaw_points_clone_some(set_.get(), 2, which.data(), set_.get(), source.data()),
        GRAINLAW_BAD_ARGUMENT, "clone to");
  }
  const Numbers outside{0, points}, inside{0, 1};
  std::array<std::size_t, 3> offsets{};
  expect_refused(grainlaw_points_save_some(set_.get(), 2, outside.data(), nullptr, offsets.data()),
                 GRAINLAW_BAD_ARGUMENT, "save");
  expect_refused(
      grainlaw_points_clone_some(set_.get(), 2, inside.data(), set_.get(), outside.data()),
      GRAINLAW_BAD_ARGUMENT, "clone from");
  expect_refused(grainlaw_points_save_some(set_.get(), points + 1, nullptr, nullptr, nullptr),
                 GRAINLAW_NULL_POINTER, "save offsets");
}

TEST_F(bad_some_points, strides_that_overlap_are_refused) {
  const auto F = deformations();
  std::vector<double> P(4 * points), A(16 * points);
  grainlaw_summary summary = grainlaw_summary_default();
  for (const auto& [f, p, a] : {std::array<std::size_t, 3>{3, 0, 0}, {0, 3, 0}, {0, 0, 15}}) {
    expect_refused(grainlaw_points_evaluate_some(set_.get(), points, nullptr, F.data(), f,
                                                 GRAINLAW_WANT_TANGENT_EXACT, P.data(), p, A.data(),
                                                 a, nullptr, nullptr, 1, &summary),
                   GRAINLAW_BAD_ARGUMENT, "stride");
    EXPECT_EQ(summary.message, f == 3   ? "F_stride is 3, expected 0 or at least 4 doubles"s
                               : p == 3 ? "P_stride is 3, expected 0 or at least 4 doubles"
                                        : "A_stride is 15, expected 0 or at least 16 doubles");
  }
}

TEST_F(bad_some_points, bytes_that_are_damaged_short_or_of_others_are_told_by_point) {
  Points other = committed_set();
  const auto saved = other.save_some(Numbers{0, 1});
  const Numbers which{4, 2};
  const auto refused = [&](std::vector<std::byte> bytes, std::vector<std::size_t> offsets,
                           grainlaw_status expected, const char* text) {
    std::array<char, 256> message{};
    expect_refused(grainlaw_points_load_some(set_.get(), 2, which.data(), bytes.data(),
                                             offsets.data(), message.data(), message.size()),
                   expected, text);
    EXPECT_NE(std::string(message.data()).find(text), std::string::npos) << message.data();
  };
  for (std::size_t k = saved.offsets[1]; k < saved.bytes.size(); k += 61) {
    auto bytes = saved.bytes;
    bytes[k] ^= std::byte{1};
    refused(bytes, saved.offsets, GRAINLAW_BAD_BYTES, "point 2: ");
  }
  for (std::size_t k = 0; k < 200; ++k) {  // of the tangent
    auto bytes = saved.bytes;
    bytes[bytes.size() - 1 - k] ^= std::byte{1};
    refused(bytes, saved.offsets, GRAINLAW_BAD_BYTES, "point 2: ");
  }
  refused(saved.bytes, {0, saved.offsets[1], saved.offsets[1] + 9}, GRAINLAW_BAD_BYTES, "point 2");
  refused(saved.bytes, {0, 0, saved.offsets[2]}, GRAINLAW_BAD_BYTES, "point 4");
  refused(saved.bytes, {9, 0, 9}, GRAINLAW_BAD_ARGUMENT, "argument");
  const Material bonded = Material::load(data_directory + "/bonded100.toml");
  Points bonds(bonded, 2);
  const auto foreign = bonds.save_some(Numbers{0, 1});
  refused(foreign.bytes, foreign.offsets, GRAINLAW_WRONG_MATERIAL, "point 4: ");
}

TEST_F(bad_some_points, a_buffer_of_other_sizes_is_not_written) {
  std::array<std::size_t, 3> offsets{};
  const Numbers which{0, 1};
  ASSERT_EQ(grainlaw_points_save_some(set_.get(), 2, which.data(), nullptr, offsets.data()),
            GRAINLAW_OK);
  std::vector<std::byte> bytes(offsets[2], std::byte{7});
  --offsets[2];
  expect_refused(
      grainlaw_points_save_some(set_.get(), 2, which.data(), bytes.data(), offsets.data()),
      GRAINLAW_BUFFER_TOO_SMALL, "short");
  EXPECT_EQ(bytes, std::vector<std::byte>(bytes.size(), std::byte{7}));
}

TEST_F(bad_some_points, null_pointers_dead_handles_and_other_dimensions_are_refused) {
  const Material spheres = Material::load(data_directory + "/spheres500.toml");
  Points space(spheres, 1);
  const Numbers first{0};
  expect_refused(grainlaw_points_clone_some(set_.get(), 1, first.data(), space.get(), first.data()),
                 GRAINLAW_BAD_ARGUMENT, "clone spheres");
  expect_refused(grainlaw_points_resize(set_.get(), points + 1, spheres.get()),
                 GRAINLAW_BAD_ARGUMENT, "resize by spheres");
  expect_refused(grainlaw_points_resize(set_.get(), SIZE_MAX, nullptr), GRAINLAW_OUT_OF_MEMORY,
                 "resize");
  EXPECT_EQ(set_.size(), points);
  double value = 0;
  std::size_t offsets[2] = {0, 0};
  expect_refused(grainlaw_points_cost(set_.get(), nullptr), GRAINLAW_NULL_POINTER, "seconds");
  expect_refused(grainlaw_points_load_some(set_.get(), 1, nullptr, nullptr, offsets, nullptr, 0),
                 GRAINLAW_NULL_POINTER, "bytes");
  expect_refused(grainlaw_points_load_some(set_.get(), 1, nullptr, &value, nullptr, nullptr, 0),
                 GRAINLAW_NULL_POINTER, "offsets");
  for (const unsigned want : {3U, 8U})
    expect_refused(grainlaw_points_answer(set_.get(), want, &value, nullptr, 1, nullptr),
                   GRAINLAW_BAD_ARGUMENT, "want");
  alignas(16) std::array<std::uint64_t, 64> dead{};
  for (grainlaw_points* wrong :
       {static_cast<grainlaw_points*>(nullptr), reinterpret_cast<grainlaw_points*>(dead.data())}) {
    const auto expected = wrong == nullptr ? GRAINLAW_NULL_POINTER : GRAINLAW_BAD_HANDLE;
    const auto refused = [&](grainlaw_status found, const char* what) {
      expect_refused(found, expected, what);
    };
    refused(grainlaw_points_evaluate_some(wrong, 0, nullptr, &value, 0, 0, nullptr, 0, nullptr, 0,
                                          nullptr, nullptr, 1, nullptr),
            "evaluate_some");
    refused(grainlaw_points_answer(wrong, 0, &value, nullptr, 1, nullptr), "answer");
    refused(grainlaw_points_cost(wrong, &value), "cost");
    refused(grainlaw_points_save_some(wrong, 0, nullptr, nullptr, offsets), "save_some");
    refused(grainlaw_points_load_some(wrong, 0, nullptr, &value, offsets, nullptr, 0), "load_some");
    refused(grainlaw_points_resize(wrong, 1, nullptr), "resize");
    refused(grainlaw_points_clone_some(wrong, 0, nullptr, set_.get(), nullptr), "clone to");
    refused(grainlaw_points_clone_some(set_.get(), 0, nullptr, wrong, nullptr), "clone from");
    refused(grainlaw_points_share(wrong, 0, nullptr, nullptr), "share");
    refused(grainlaw_points_agree(wrong, GRAINLAW_OK, nullptr, 0), "agree");
  }
}

}  // namespace
}  // namespace grainlaw::test
