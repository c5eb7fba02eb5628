// Batches in processes that lack what threads need: children of fork, and under limits.
#include "points_support.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>

namespace grainlaw::test {
namespace {

// GCC's macros and clang's features.
#ifdef __has_feature
#define GRAINLAW_BUILT_WITH(feature) __has_feature(feature)
#else
#define GRAINLAW_BUILT_WITH(feature) 0
#endif
#if defined(__SANITIZE_THREAD__) || GRAINLAW_BUILT_WITH(thread_sanitizer)
constexpr bool threads_are_watched = true;  // which does not work in a child of fork
#else
constexpr bool threads_are_watched = false;
#endif
#if defined(__SANITIZE_ADDRESS__) || GRAINLAW_BUILT_WITH(address_sanitizer)
constexpr bool addresses_are_watched = true;
#else
constexpr bool addresses_are_watched = false;
#endif

int threads_of_this_process() {
  int count = 0;
  for ([[maybe_unused]] const auto& task : std::filesystem::directory_iterator("/proc/self/task"))
    ++count;
  return count;
}

// Whether body() is true in a child of this process, in reasonable time.
template <class Body>
bool true_in_a_child(Body&& body) {
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(60);
    ::_exit(body() ? 0 : 1);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void limit(int resource, rlim_t value) {
  rlimit limit{};
  ::getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  limit.rlim_cur = value;
  ASSERT_EQ(::setrlimit(static_cast<__rlimit_resource>(resource), &limit), 0);
}

class process : public testing::Test {
 protected:
  void SetUp() override {
    if (threads_are_watched) GTEST_SKIP() << "not under the thread sanitizer";
    expected_ = evaluate(states_, 2);
  }
  std::vector<State> states_ = states();
  Result expected_;
};

TEST_F(process, a_child_of_fork_has_the_same_answers_and_so_has_its_child) {
  EXPECT_TRUE(true_in_a_child([&] {
    return same_bits(evaluate(states_, 2), expected_) &&
           true_in_a_child([&] { return same_bits(evaluate(states_, 4), expected_); }) &&
           same_bits(evaluate(states_, 2), expected_);
  }));
  EXPECT_TRUE(same_bits(evaluate(states_, 2), expected_));
}

TEST_F(process, a_set_in_a_child_of_fork_has_the_same_answers) {
  Points set = make_set();
  EXPECT_TRUE(same_bits(evaluate(set, 2), expected_));
  EXPECT_TRUE(true_in_a_child([&] { return same_bits(evaluate(set, 4), expected_); }));
  EXPECT_TRUE(same_bits(evaluate(set, 2), expected_));
}

TEST_F(process, a_child_of_fork_starts_threads_of_its_own) {
  EXPECT_TRUE(true_in_a_child([&] {
    if (threads_of_this_process() != 1) return false;
    evaluate(states_, 3);
    return threads_of_this_process() == 3;
  }));
}

TEST_F(process, without_more_threads_the_answers_are_the_same) {
  EXPECT_TRUE(true_in_a_child([&] {
    if (::geteuid() == 0 && ::setuid(65534) != 0) return false;  // root has no limit
    limit(RLIMIT_NPROC, 0);
    return same_bits(evaluate(states_, 8), expected_) && threads_of_this_process() == 1;
  }));
}

// Room for no stack of a thread, then for ever more.
TEST_F(process, with_little_memory_points_are_done_or_told_and_then_done) {
  if (addresses_are_watched)
    GTEST_SKIP() << "the address sanitizer itself ends a process that has no memory";
  for (const std::size_t room : {0UL, 1UL << 20, 1UL << 22, 1UL << 24, 1UL << 26, 1UL << 28}) {
    EXPECT_TRUE(true_in_a_child([&] {
      const auto F = deformations();
      auto all = handles(states_);
      std::ifstream pages("/proc/self/statm");
      std::size_t used = 0;
      pages >> used;
      Result found;
      rlimit before{};
      ::getrlimit(RLIMIT_AS, &before);
      limit(RLIMIT_AS, used * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + room);
      grainlaw_evaluate_batch(points, all.data(), F.data(), GRAINLAW_WANT_TANGENT_EXACT,
                              found.P.data(), found.A.data(), found.status.data(), nullptr, 8);
      ::setrlimit(RLIMIT_AS, &before);
      for (const grainlaw_status status : found.status)
        if (status != GRAINLAW_OK && status != GRAINLAW_OUT_OF_MEMORY) return false;
      return same_bits(evaluate(states_, 8), expected_);
    })) << room
        << " bytes";
  }
}

}  // namespace
}  // namespace grainlaw::test
