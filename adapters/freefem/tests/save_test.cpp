// A save in which any call of the system or any allocation fails: an error, the last good file, the
// states as they were.
#include "../../point/test/failing_allocation.hpp"
#include "../../point/test/failing_calls.hpp"
#include "../point_set.hpp"
#include "temporary_directory.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>

namespace grainlaw::test {
namespace {

using grainlaw_freefem::Array;
using grainlaw_freefem::PointSet;

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class freefem_save : public testing::Test {
 protected:
  freefem_save() {
    go(1e-4);
    points.save(path);
    before = bytes_of(path);
    go(2e-4);
    points.save(path);
    after = bytes_of(path);
    EXPECT_TRUE(before != after);
  }

  void go(double shortening) {
    std::vector<double> F{1, 0, 0, 1 - shortening, 1, 0, 0, 1}, P(8);
    ASSERT_EQ(points.evaluate({F.data(), {8}}, {P.data(), {8}}, nullptr, 1), 0);
    points.commit();
  }
  // Whether one more save got through; it is all or nothing.
  bool tried(const std::function<void()>& arm, const std::function<void()>& disarm) {
    std::ofstream(path, std::ios::binary) << before;
    bool saved = true;
    arm();
    try {
      points.save(path);
    } catch (const std::exception&) {
      saved = false;
    }
    disarm();
    EXPECT_TRUE(bytes_of(path) == (saved ? after : before));
    namespace fs = std::filesystem;
    EXPECT_EQ(std::distance(fs::directory_iterator(directory.path()), fs::directory_iterator()), 1);
    points.save(path);
    EXPECT_TRUE(bytes_of(path) == after);
    return saved;
  }

  TemporaryDirectory directory;
  std::string path = directory / "points", before, after;
  PointSet points{{GRAINLAW_TEST_DATA "/bonded100.toml"}, {2}};
};

TEST_F(freefem_save, with_a_call_of_the_system_that_fails) {
  fail_call(0);
  points.save(path);
  const int all = calls();
  EXPECT_GE(all, 5);
  int failed = 0;
  for (int call = 1; call <= all; ++call) {
    failed += !tried([&] { fail_call(call); }, [] { fail_call(0); });
  }
  EXPECT_GE(failed, all - 3);  // nothing after the rename is lost any more
}

TEST_F(freefem_save, with_an_allocation_that_fails) {
  fail_allocation(0);
  points.save(path);
  const long all = allocations();
  EXPECT_GE(all, 5);
  int failed = 0;
  for (long allocation = 1; allocation <= all; ++allocation) {
    failed += !tried([&] { fail_allocation(allocation); }, [] { fail_allocation(0); });
  }
  EXPECT_EQ(failed, all);
}

}  // namespace
}  // namespace grainlaw::test
