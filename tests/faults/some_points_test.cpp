// Every allocation fails in turn in calls for some points, tables and materials as bytes: it is told,
// nothing changes, and the same call is then done.
#include "allocator.hpp"
#include "materials.hpp"

#include <grainlaw/trials.h>

#include <array>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace grainlaw::core::test {
namespace {

constexpr std::size_t n = 2;
constexpr std::array<double, 4> target{1.0002, 1e-4, -2e-4, 0.9995};
using Bytes = std::vector<char>;

template <class Handle>
Bytes saved(const Handle* handle, grainlaw_status save(const Handle*, void*, std::size_t*)) {
  std::size_t size = 0;
  EXPECT_EQ(save(handle, nullptr, &size), GRAINLAW_OK);
  Bytes bytes(size);
  EXPECT_EQ(save(handle, bytes.data(), &size), GRAINLAW_OK);
  return bytes;
}

class some_points_without_memory : public testing::Test {
 protected:
  some_points_without_memory() {
    EXPECT_EQ(grainlaw_points_create(&material_, n, &set_), GRAINLAW_OK);
    EXPECT_EQ(grainlaw_points_create(&material_, n, &other_), GRAINLAW_OK);
    std::vector<double> F(target.begin(), target.end()), A(16 * n);
    F.insert(F.end(), target.begin(), target.end());
    EXPECT_EQ(grainlaw_points_evaluate(other_, F.data(), GRAINLAW_WANT_TANGENT_EXACT, nullptr,
                                       A.data(), nullptr, nullptr, 1, nullptr),
              GRAINLAW_OK);
    EXPECT_EQ(grainlaw_points_commit(other_), GRAINLAW_OK);
  }
  ~some_points_without_memory() override {
    grainlaw_points_destroy(set_);
    grainlaw_points_destroy(other_);
  }
  [[nodiscard]] Bytes bytes() const { return saved<grainlaw_points>(set_, grainlaw_points_save); }

  // The call is refused each of its allocations, which changes no bytes, and then is done.
  static void expect_told(const std::function<grainlaw_status()>& call,
                          const std::function<Bytes()>& state, long least) {
    const Bytes before = state();
    for (long k = 1;; ++k) {
      grainlaw_status status = GRAINLAW_INTERNAL_FAULT;
      if (!with_refused_allocation(k, Refuse::one, [&] { status = call(); }).refused) {
        EXPECT_EQ(status, GRAINLAW_OK);
        EXPECT_GT(k, least);
        return;
      }
      ASSERT_EQ(status, GRAINLAW_OUT_OF_MEMORY) << "allocation " << k;
      EXPECT_EQ(state(), before) << "allocation " << k;
    }
  }

  grainlaw_material material_{make_material(describe(small_packing(), rough_law()))};
  grainlaw_points* set_ = nullptr;
  grainlaw_points* other_ = nullptr;
};

TEST_F(some_points_without_memory, are_copied_all_or_none) {
  expect_told([&] { return grainlaw_points_clone_some(set_, n, nullptr, other_, nullptr); },
              [&] { return bytes(); }, n);
  EXPECT_EQ(bytes(), saved<grainlaw_points>(other_, grainlaw_points_save));
}

TEST_F(some_points_without_memory, are_loaded_all_or_none) {
  std::array<std::size_t, n + 1> offsets{};
  ASSERT_EQ(grainlaw_points_save_some(other_, n, nullptr, nullptr, offsets.data()), GRAINLAW_OK);
  Bytes parts(offsets[n]);
  ASSERT_EQ(grainlaw_points_save_some(other_, n, nullptr, parts.data(), offsets.data()),
            GRAINLAW_OK);
  expect_told(
      [&] {
        return grainlaw_points_load_some(set_, n, nullptr, parts.data(), offsets.data(), nullptr,
                                         0);
      },
      [&] { return bytes(); }, n);
}

TEST_F(some_points_without_memory, get_trials_all_or_none) {
  const auto trials_of = [](grainlaw_points* set) {
    std::array<std::size_t, n + 1> offsets{};
    EXPECT_EQ(grainlaw_points_save_trials(set, n, nullptr, 1, nullptr, offsets.data()),
              GRAINLAW_OK);
    Bytes found(offsets[n]);
    EXPECT_EQ(grainlaw_points_save_trials(set, n, nullptr, 1, found.data(), offsets.data()),
              GRAINLAW_OK);
    return std::pair(found, offsets);
  };
  grainlaw_points* same = nullptr;
  ASSERT_EQ(grainlaw_points_create(&material_, n, &same), GRAINLAW_OK);
  std::vector<double> F(target.begin(), target.end()), A(16 * n);
  F.insert(F.end(), target.begin(), target.end());
  ASSERT_EQ(grainlaw_points_evaluate(same, F.data(), GRAINLAW_WANT_TANGENT_EXACT, nullptr, A.data(),
                                     nullptr, nullptr, 1, nullptr),
            GRAINLAW_OK);
  const auto saved = trials_of(same);
  expect_told(
      [&] {
        return grainlaw_points_load_trials(set_, n, nullptr, saved.first.data(),
                                           saved.second.data(), nullptr, 0);
      },
      [&] { return trials_of(set_).first; }, n);
  EXPECT_EQ(trials_of(set_), saved);
  grainlaw_points_destroy(same);
}

TEST_F(some_points_without_memory, become_more_or_stay) {
  expect_told([&] { return grainlaw_points_resize(set_, n + 3, nullptr); }, [&] { return bytes(); },
              3);
  EXPECT_EQ(grainlaw_points_size(set_), n + 3);
}

TEST_F(some_points_without_memory, of_a_table_stay_as_they_were) {
  grainlaw_table* table = nullptr;
  ASSERT_EQ(grainlaw_table_create(&material_, &table), GRAINLAW_OK);
  const auto state = [&] { return saved<grainlaw_table>(table, grainlaw_table_save); };
  constexpr std::array<double, 4> one{1, 0, 0, 1}, further{1.0004, 1e-4, -2e-4, 0.999};
  double token = 0;
  const auto evaluate = [&](double from, const double* F0, const double* F) {
    token = from;
    const auto status =
        grainlaw_table_evaluate(table, 1, 1, &token, F0, F, 0, 0, nullptr, nullptr, nullptr);
    EXPECT_EQ(token, status == GRAINLAW_OK ? from + 1 : from);
    return status;
  };
  ASSERT_EQ(evaluate(0, nullptr, one.data()), GRAINLAW_OK);
  expect_told([&] { return evaluate(0, one.data(), target.data()); }, state, 1);
  // Accepted by a call that fails before or after: found again by the same call.
  for (long k = 1;; ++k) {
    grainlaw_status status = GRAINLAW_INTERNAL_FAULT;
    const auto call = [&] { status = evaluate(1, target.data(), further.data()); };
    const bool refused = with_refused_allocation(k, Refuse::one, call).refused;
    EXPECT_EQ(status, refused ? GRAINLAW_OUT_OF_MEMORY : GRAINLAW_OK) << "allocation " << k;
    if (!refused) break;
  }
  EXPECT_EQ(evaluate(2, further.data(), further.data()), GRAINLAW_OK);
  const Bytes before = state();
  expect_told([&] { return grainlaw_table_load(table, before.data(), before.size(), nullptr, 0); },
              state, 2);
  grainlaw_table_destroy(table);
}

TEST_F(some_points_without_memory, of_a_saved_material_are_made_later) {
  const Bytes all = saved<grainlaw_material>(&material_, grainlaw_material_save);
  grainlaw_material* made = nullptr;
  expect_told(
      [&] { return grainlaw_material_load_saved(all.data(), all.size(), &made, nullptr, 0); },
      [&] { return made == nullptr ? Bytes{} : Bytes{1}; }, 5);
  EXPECT_EQ(saved<grainlaw_material>(made, grainlaw_material_save), all);
  grainlaw_material_destroy(made);
}

}  // namespace
}  // namespace grainlaw::core::test
