// What stood in a file stays, whatever a write meets, until the new one is whole.
#include "whole_file.hpp"
#include "failing_calls.hpp"
#include "temporary_directory.hpp"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>
#include <iterator>

namespace grainlaw::test {
namespace {

using adapters::WholeFile;

class whole_file : public testing::Test {
 protected:
  whole_file() { put("old"); }

  void put(const std::string& text) const { std::ofstream(path) << text; }
  std::string got() const {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::ptrdiff_t files() const {
    namespace fs = std::filesystem;
    return std::distance(fs::directory_iterator(directory.path()), fs::directory_iterator());
  }
  void save(const std::string& text) const {
    WholeFile file(path);
    file.write(text.data(), text.size() / 2);
    file.write(text.data() + text.size() / 2, text.size() - text.size() / 2);
    file.keep();
  }
  std::string refused(const std::string& text) const {
    try {
      save(text);
    } catch (const std::exception& error) {
      return error.what();
    }
    return {};
  }

  TemporaryDirectory directory;
  std::string path = directory / "points";
};

TEST_F(whole_file, takes_the_place_of_the_old_one) {
  save("new");
  EXPECT_EQ(got(), "new");
  EXPECT_EQ(files(), 1);
}

TEST_F(whole_file, is_the_old_one_until_it_is_kept) {
  {
    WholeFile file(path);
    file.write("new", 3);
    EXPECT_EQ(got(), "old");
  }
  EXPECT_EQ(got(), "old");
  EXPECT_EQ(files(), 1);
}

// 3 MiB, so that writes come before keep(), too.
TEST_F(whole_file, is_the_old_one_after_any_call_that_fails) {
  const std::string text(3 << 20, 'x');
  fail_call(0);
  save(text);
  const int all = calls();
  ASSERT_GT(all, 20);
  int failed = 0;
  for (int call = 1; call <= all; ++call) {
    put("old");
    fail_call(call);
    const std::string said = refused(text);
    fail_call(0);
    EXPECT_EQ(files(), 1) << call;
    if (said.empty()) {  // what comes after the rename cannot fail any more
      EXPECT_GT(call, all - 3);
      EXPECT_EQ(got(), text) << call;
      continue;
    }
    ++failed;
    EXPECT_EQ(said.find(path + ": cannot be written: "), 0u) << said;
    EXPECT_EQ(got(), "old") << call;
    save("new");
    EXPECT_EQ(got(), "new") << call;
  }
  EXPECT_GE(failed, all - 3);
}

TEST_F(whole_file, beyond_the_limit_of_sizes_is_an_error_and_no_signal) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{1000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string said = refused(std::string(5000, 'x'));
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_NE(said.find("File too large"), std::string::npos) << said;
  EXPECT_EQ(got(), "old");
  EXPECT_EQ(files(), 1);
  sigset_t pending;
  sigpending(&pending);
  EXPECT_EQ(sigismember(&pending, SIGXFSZ), 0);
}

TEST_F(whole_file, keeps_links_and_permissions) {
  std::string link = directory / "link";
  std::filesystem::create_symlink(path, link);
  ::chmod(path.c_str(), 0640);
  std::swap(path, link);
  save("new");
  EXPECT_EQ(got(), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(path));
  struct stat found {};
  ASSERT_EQ(::stat(path.c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777, 0640u);
}

TEST_F(whole_file, a_device_stays_one) {
  path = "/dev/full";
  EXPECT_NE(refused("new").find("No space left"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_character_file(path));
  path = "/dev/null";
  save("new");
  EXPECT_TRUE(std::filesystem::is_character_file(path));
}

TEST_F(whole_file, tells_of_a_folder_that_is_not_there) {
  path = directory / "nowhere/points";
  EXPECT_EQ(refused("new"), path + ": cannot be written: No such file or directory");
}

}  // namespace
}  // namespace grainlaw::test
