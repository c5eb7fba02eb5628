// The command knows the files that it has made, whenever it was killed, and takes no others for them.
#include "../temporary_directory.hpp"

#include "app/atomic_file.hpp"
#include "app/csv.hpp"
#include "app/library.hpp"
#include "app/own_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace verification {
namespace {

using grainlaw::test::TemporaryDirectory;

class own_files : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return directory_.path() / name;
  }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  [[nodiscard]] std::string contents(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  [[nodiscard]] std::ptrdiff_t lines() const {
    const std::string list = contents(".grainlaw/written");
    return std::count(list.begin(), list.end(), '\n');
  }
  // Acts like a process that begins with reading the list.
  template <class Action>
  void process(Action&& action, OwnFiles::Others others = OwnFiles::Others::keep) const {
    const OwnFiles own(others);
    action();
  }
  [[nodiscard]] bool is_own(const std::string& name) const {
    bool own = false;
    process([&] { own = !is_of_others(path(name)); });
    return own;
  }

  TemporaryDirectory directory_;
};

TEST_F(own_files, are_written_over_and_others_are_kept) {
  put("theirs", "theirs");
  process([&] { write_file(path("ours"), "first"); });
  process([&] { write_file(path("ours"), "second"); });
  EXPECT_EQ(contents("ours"), "second");
  process([&] {
    EXPECT_THROW(write_file(path("theirs"), "ours"), ComputationError);
    EXPECT_THROW(write_atomically(path("theirs"), "ours"), ComputationError);
    EXPECT_THROW(write_together({{path("new"), "ours"}, {path("theirs"), "ours"}}),
                 ComputationError);
    EXPECT_THROW(CsvWriter(path("theirs"), {"a[-]"}), ComputationError);
    EXPECT_THROW(write_csv(path("theirs"), {"a[-]"}, {}), ComputationError);
  });
  EXPECT_EQ(contents("theirs"), "theirs");
  EXPECT_FALSE(std::filesystem::exists(path("new")));
  put("ours", "theirs");
  EXPECT_FALSE(is_own("ours"));
  process([&] { write_file(path("ours"), "third"); }, OwnFiles::Others::write_over);
  EXPECT_TRUE(is_own("ours"));
}

TEST_F(own_files, are_those_of_programs_without_the_list_too) {
  put("theirs", "theirs");
  write_file(path("theirs"), "ours");
  EXPECT_EQ(contents("theirs"), "ours");
  EXPECT_FALSE(std::filesystem::exists(path(".grainlaw")));
}

TEST_F(own_files, that_are_tables_may_end_after_any_row_and_are_not_changed_when_they_are_whole) {
  process([&] {
    CsvWriter table(path("t"), {"a[-]"});
    table.row({1});
    const std::string begun = contents("t");
    for (const std::string& left : {std::string("a[-]\n"), begun, begun + "2\n"}) {
      put("t", left);
      EXPECT_FALSE(is_of_others(path("t"))) << left;
    }
    put("t", "b[-]\n1\n");
    EXPECT_TRUE(is_of_others(path("t")));
    put("t", begun);
  });
  EXPECT_TRUE(is_own("t"));
  put("t", "a[-]\n2\n");
  EXPECT_FALSE(is_own("t"));
  put("t", "a[-]\n1\n");
  process([&] { CsvWriter(path("t"), {"a[-]"}, 5).row({3}); });
  EXPECT_EQ(contents("t"), "a[-]\n3\n");
  EXPECT_TRUE(is_own("t"));
}

// Killed between the list and the file, once and again.
TEST_F(own_files, stay_so_where_writing_fails) {
  process([&] { write_file(path("f"), "old"); });
  for (const char* text : {"one", "two", "three"}) {
    process([&] { list_before(path("f"), text, Content::whole); });
    EXPECT_TRUE(is_own("f")) << text;
  }
  put("f", "three");
  EXPECT_TRUE(is_own("f"));
  put("f", "one");
  EXPECT_FALSE(is_own("f"));
}

TEST_F(own_files, are_not_links_of_others) {
  put("theirs", "theirs");
  std::filesystem::create_symlink(path("theirs"), path("link"));
  std::filesystem::create_symlink(path("nothing"), path("broken"));
  process([&] {
    for (const char* name : {"link", "broken"})
      EXPECT_THROW(write_file(path(name), "ours"), ComputationError) << name;
  });
  process([&] { write_file(path("link"), "ours"); }, OwnFiles::Others::write_over);
  EXPECT_TRUE(std::filesystem::is_symlink(path("link")));
  EXPECT_EQ(contents("theirs"), "ours");
}

TEST_F(own_files, that_are_tables_begin_anew_beside_hard_links_to_the_old_ones) {
  process([&] { CsvWriter(path("t"), {"a[-]"}).row({1}); });
  std::filesystem::create_hard_link(path("t"), path("kept"));
  process([&] { CsvWriter(path("t"), {"a[-]"}).row({2}); });
  EXPECT_EQ(contents("t"), "a[-]\n2\n");
  EXPECT_EQ(contents("kept"), "a[-]\n1\n");
}

TEST_F(own_files, are_listed_shortly_and_beside_what_others_list) {
  process([&] {
    for (int k = 0; k < 1500; ++k) write_file(path("f"), std::to_string(k));
    for (int k = 0; k < 3; ++k) write_file(path("same"), "same");
  });
  EXPECT_EQ(lines(), 1503);
  process([&] {
    EXPECT_FALSE(is_of_others(path("f")));  // read now
    put(".grainlaw/written", contents(".grainlaw/written") + "= 3 0123456789abcdef another\n");
    write_file(path("g"), "new");
  });
  EXPECT_NE(contents(".grainlaw/written").find(" another\n"), std::string::npos);
  EXPECT_EQ(lines(), 7);
  for (const char* name : {"f", "same", "g"}) EXPECT_TRUE(is_own(name)) << name;
}

TEST_F(own_files, are_written_first_where_nothing_of_others_is) {
  put("f.new", "theirs");
  process([&] {
    std::filesystem::create_directory(path(".grainlaw"));
    put(".grainlaw/f.new", "left by a process that was killed");
    write_file(path("f"), "ours");
  });
  EXPECT_EQ(contents("f"), "ours");
  EXPECT_EQ(contents("f.new"), "theirs");
  EXPECT_FALSE(std::filesystem::exists(path(".grainlaw/f.new")));
}

}  // namespace
}  // namespace verification
