// Files are the old ones or the whole new ones, whatever prevents the writing.
#include "io/text_file.hpp"
#include "../temporary_directory.hpp"
#include "base/error.hpp"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/stat.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <iterator>
#include <string>

namespace grainlaw::core {
namespace {

// While it lives, no file grows beyond so many bytes.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

class text_file : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return directory_ / name; }
  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(std::filesystem::directory_iterator(directory_.path()), {});
  }
  static void expect_error(const std::string& part, const auto& action) {
    try {
      action();
      ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error.status, GRAINLAW_FILE_ERROR);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }

  test::TemporaryDirectory directory_;
};

TEST_F(text_file, that_cannot_be_written_whole_leaves_the_old_one) {
  write_text(path("a"), "old");
  {
    const SmallDisk disk(1000);
    const std::string large(5000, 'x');
    expect_error(path("a"), [&] { write_text(path("a"), large); });
    // The first of these could be written.
    expect_error(path("b"), [&] {
      write_together(std::array<TextFile, 2>{{{path("a"), "new"}, {path("b"), large}}});
    });
  }
  EXPECT_EQ(read_text(path("a")), "old");
  EXPECT_EQ(files(), 1);
  write_together(std::array<TextFile, 2>{{{path("a"), "new"}, {path("b"), "too"}}});
  EXPECT_EQ(read_text(path("a")) + read_text(path("b")), "newtoo");
  EXPECT_EQ(files(), 2);
  expect_error("No such file", [&] { write_text(path("missing/a"), "new"); });
}

TEST_F(text_file, keeps_its_mode_and_the_link_that_leads_to_it) {
  write_text(path("a"), "old");
  std::filesystem::permissions(path("a"), std::filesystem::perms::owner_all);
  std::filesystem::create_symlink("a", path("link"));
  write_text(path("link"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(path("link")));
  EXPECT_EQ(read_text(path("a")), "new");
  EXPECT_EQ(std::filesystem::status(path("a")).permissions(), std::filesystem::perms::owner_all);
}

TEST_F(text_file, that_is_a_device_is_written_to) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  expect_error("No space left", [] { write_text("/dev/full", "text"); });
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  write_text("/dev/null", "text");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(text_file, that_may_have_no_end_is_not_read) {
  expect_error("/dev/zero: cannot be read: found a pipe or device", [] { read_text("/dev/zero"); });
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  expect_error("expected a file", [&] { read_text(path("pipe")); });
  expect_error("pipe: cannot be written", [&] { write_text(path("pipe"), "x"); });
  expect_error("pipe: cannot be written", [&] { GrowingFile file(path("pipe")); });
}

TEST_F(text_file, of_a_spreadsheet_is_read_without_its_mark) {
  write_text(path("a"), "\xef\xbb\xbfx,y\n");
  EXPECT_EQ(read_text(path("a")), "x,y\n");
}

}  // namespace
}  // namespace grainlaw::core
