// Every allocation that a set of points asks for fails in turn: it is told, nothing changes, and the
// same call is then done.
#include "allocator.hpp"
#include "materials.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <functional>
#include <thread>
#include <vector>

namespace grainlaw::core::test {
namespace {

constexpr std::size_t n = 3;
constexpr std::array<double, 4 * n> target{1,     0,      0, 1, 1.0002, 1e-4,
                                           -2e-4, 0.9995, 1, 0, 1e-4,   0.9995};

struct DestroyPoints {
  void operator()(grainlaw_points* set) const { grainlaw_points_destroy(set); }
};
using Set = std::unique_ptr<grainlaw_points, DestroyPoints>;

std::vector<char> saved(const grainlaw_points* set) {
  std::size_t size = 0;
  EXPECT_EQ(grainlaw_points_save(set, nullptr, &size), GRAINLAW_OK);
  std::vector<char> bytes(size);
  EXPECT_EQ(grainlaw_points_save(set, bytes.data(), &size), GRAINLAW_OK);
  return bytes;
}

struct Answer {
  grainlaw_status status = GRAINLAW_INTERNAL_FAULT;
  std::array<double, 4 * n> stress{};
  std::array<double, 16 * n> tangent{};
  grainlaw_summary summary = grainlaw_summary_default();

  bool operator==(const Answer& other) const {  // bit for bit
    return status == other.status && std::memcmp(&stress, &other.stress, sizeof stress) == 0 &&
           std::memcmp(&tangent, &other.tangent, sizeof tangent) == 0 &&
           std::memcmp(&summary, &other.summary, sizeof summary) == 0;
  }
};

Answer evaluate(grainlaw_points* set) {
  Answer answer;
  answer.status = grainlaw_points_evaluate(set, target.data(), GRAINLAW_WANT_TANGENT_EXACT,
                                           answer.stress.data(), answer.tangent.data(), nullptr,
                                           nullptr, 1, &answer.summary);
  return answer;
}

class points_without_memory : public testing::Test {
 protected:
  [[nodiscard]] Set make() const {
    grainlaw_points* set = nullptr;
    EXPECT_EQ(grainlaw_points_create(&material_, n, &set), GRAINLAW_OK);
    return Set(set);
  }
  // A set with a trial that is not committed.
  [[nodiscard]] Set with_trial() const {
    Set set = make();
    EXPECT_EQ(evaluate(set.get()).status, GRAINLAW_OK);
    return set;
  }
  // The call is refused each of its allocations, and others after it, and then is done.
  static void expect_told(const std::function<grainlaw_status()>& call,
                          const std::function<void()>& nothing_changed,
                          const std::function<void()>& undo, long least) {
    for (const Refuse how : {Refuse::one, Refuse::rest}) {
      long k = 1;
      for (;; ++k) {
        grainlaw_status status = GRAINLAW_INTERNAL_FAULT;
        const auto found = with_refused_allocation(k, how, [&] { status = call(); });
        if (!found.refused) {
          EXPECT_EQ(status, GRAINLAW_OK);
          break;
        }
        ASSERT_EQ(status, GRAINLAW_OUT_OF_MEMORY) << "allocation " << k;
        EXPECT_EQ(found.kept, 0) << "allocation " << k;
        nothing_changed();
      }
      EXPECT_GT(k, least);
      undo();
    }
  }

  grainlaw_material material_{make_material(describe(small_packing(), rough_law()))};
};

TEST_F(points_without_memory, are_not_made) {
  grainlaw_points* set = nullptr;
  expect_told([&] { return grainlaw_points_create(&material_, n, &set); },
              [&] { EXPECT_EQ(set, nullptr); },
              [&] {
                EXPECT_EQ(grainlaw_points_size(set), n);
                grainlaw_points_destroy(set);
              },
              n);
}

TEST_F(points_without_memory, are_not_copied) {
  const Set original = with_trial();
  grainlaw_points* set = nullptr;
  expect_told([&] { return grainlaw_points_clone(original.get(), &set); },
              [&] { EXPECT_EQ(set, nullptr); },
              [&] {
                EXPECT_EQ(grainlaw_points_commit(set), GRAINLAW_OK);
                grainlaw_points_destroy(set);
              },
              n);
}

TEST_F(points_without_memory, have_their_particles_listed_later) {
  const Set set = with_trial();
  const grainlaw_state* const state = grainlaw_points_state(set.get(), 0);
  std::size_t count = 0;
  ASSERT_EQ(grainlaw_state_contacts(state, nullptr, sizeof(grainlaw_contact), &count), GRAINLAW_OK);
  std::vector<grainlaw_contact> contacts(count);
  expect_told(
      [&] {
        return grainlaw_state_contacts(state, contacts.data(), sizeof(grainlaw_contact), &count);
      },
      [&] { EXPECT_EQ(contacts[0].weight, 0); },
      [&] {
        EXPECT_EQ(contacts[0].weight, 1);
        contacts.assign(count, {});
      },
      3);
}

TEST_F(points_without_memory, are_all_evaluated_later) {
  Answer expected;
  std::thread([&] { expected = evaluate(make().get()); }).join();
  ASSERT_EQ(expected.status, GRAINLAW_OK) << expected.summary.message;
  bool refused = true;
  long k = 0;
  while (refused && !HasFailure()) {
    ++k;
    std::thread([&] {  // without the memory of earlier evaluations
      const Set set = make();
      const auto before = saved(set.get());
      Answer answer;
      refused =
          with_refused_allocation(k, Refuse::one, [&] { answer = evaluate(set.get()); }).refused;
      if (refused) {
        EXPECT_EQ(answer.status, GRAINLAW_OUT_OF_MEMORY) << "allocation " << k;
        EXPECT_EQ(answer.summary.failed, 1) << "allocation " << k;
        EXPECT_STREQ(answer.summary.message, grainlaw_status_text(GRAINLAW_OUT_OF_MEMORY));
        EXPECT_EQ(grainlaw_points_commit(set.get()), GRAINLAW_NO_TRIAL) << "allocation " << k;
        EXPECT_EQ(saved(set.get()), before) << "allocation " << k;
      }
      EXPECT_TRUE(evaluate(set.get()) == expected) << "after allocation " << k;
    })
        .join();
  }
  EXPECT_GT(k, 100);
}

// Ranks wait in as many reductions for one that has no memory as for one that has.
TEST_F(points_without_memory, do_not_leave_other_ranks_waiting) {
  const auto count = [](void* reductions, double*, int, grainlaw_op) {
    ++*static_cast<int*>(reductions);
  };
  bool refused = true;
  for (long k = 1; refused && !HasFailure(); ++k) {
    std::thread([&] {  // without the memory of earlier evaluations
      const Set set = make();
      int reductions = 0;
      EXPECT_EQ(grainlaw_points_share(set.get(), 0, count, &reductions), GRAINLAW_OK);
      Answer answer;
      refused =
          with_refused_allocation(k, Refuse::rest, [&] { answer = evaluate(set.get()); }).refused;
      EXPECT_EQ(answer.status, refused ? GRAINLAW_OUT_OF_MEMORY : GRAINLAW_OK);
      EXPECT_EQ(reductions, refused ? 2 : 1) << "allocation " << k;  // the second tells why
      EXPECT_EQ(grainlaw_points_commit(set.get()), refused ? GRAINLAW_NO_TRIAL : GRAINLAW_OK);
      EXPECT_EQ(reductions, refused ? 3 : 2);
    })
        .join();
  }
}

TEST_F(points_without_memory, are_all_loaded_or_none) {
  const Set other = with_trial();
  ASSERT_EQ(grainlaw_points_commit(other.get()), GRAINLAW_OK);
  const auto bytes = saved(other.get());
  const Set set = with_trial();
  const auto before = saved(set.get());
  char message[64] = "";
  const auto load = [&] {
    return grainlaw_points_load(set.get(), bytes.data(), bytes.size(), message, sizeof message);
  };
  for (long k = 1;; ++k) {
    grainlaw_status status = GRAINLAW_INTERNAL_FAULT;
    if (!with_refused_allocation(k, Refuse::one, [&] { status = load(); }).refused) {
      EXPECT_GT(k, long{n});
      break;
    }
    ASSERT_EQ(status, GRAINLAW_OUT_OF_MEMORY) << "allocation " << k;
    EXPECT_STREQ(message, grainlaw_status_text(GRAINLAW_OUT_OF_MEMORY));
    EXPECT_EQ(saved(set.get()), before) << "allocation " << k;
  }
  EXPECT_EQ(saved(set.get()), bytes);
}

TEST_F(points_without_memory, have_no_measure) {
  const Set set = with_trial();
  std::array<double, n> values{};
  expect_told(
      [&] {
        std::size_t count = n;
        return grainlaw_points_measure(set.get(), GRAINLAW_MEAN_OVERLAP, values.data(), &count);
      },
      [&] { EXPECT_EQ(values, (std::array<double, n>{})); },
      [&] {
        EXPECT_NE(values, (std::array<double, n>{}));
        values = {};
      },
      n);
}

// All that a set needs beside its points' own memory was taken when it was made.
TEST_F(points_without_memory, are_evaluated_committed_and_reverted_once_warm) {
  const Set set = with_trial();
  Answer answer;
  grainlaw_status committed = GRAINLAW_INTERNAL_FAULT, reverted = committed;
  ASSERT_EQ(grainlaw_points_commit(set.get()), GRAINLAW_OK);
  ASSERT_EQ(evaluate(set.get()).status, GRAINLAW_OK);
  ASSERT_EQ(grainlaw_points_commit(set.get()), GRAINLAW_OK);
  const auto found = with_refused_allocation(0, Refuse::one, [&] {
    answer = evaluate(set.get());
    committed = grainlaw_points_commit(set.get());
    reverted = grainlaw_points_revert(set.get());
  });
  EXPECT_EQ(found.asked, 0);
  EXPECT_EQ(answer.status, GRAINLAW_OK);
  EXPECT_EQ(committed, GRAINLAW_OK);
  EXPECT_EQ(reverted, GRAINLAW_OK);
}

}  // namespace
}  // namespace grainlaw::core::test
