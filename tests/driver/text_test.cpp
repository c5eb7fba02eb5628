// Text of users in other languages, and as names of files.
#include "app/text.hpp"
#include "../temporary_directory.hpp"
#include "app/csv.hpp"
#include "app/table.hpp"
#include "io/csv_records.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace verification {
namespace {

using grainlaw::test::TemporaryDirectory;

TEST(text, of_gnuplot_is_between_single_quotes_and_on_one_line) {
  EXPECT_EQ(gnuplot_text("a `b` \"c\" \\n @x $y"), "'a `b` \"c\" \\n @x $y'");
  EXPECT_EQ(gnuplot_text("it's"), "'it''s'");
  EXPECT_EQ(gnuplot_text("one\ntwo"), "'one'.\"\\012\".'two'");
}

TEST(text, of_xml_has_no_markup_and_no_character_that_xml_cannot_hold) {
  EXPECT_EQ(xml_text("<a b=\"c\" & 'd'>\n\x01"),
            "&lt;a b=&quot;c&quot; &amp; 'd'&gt;&#10;\xEF\xBF\xBD");
  EXPECT_EQ(xml_text("é \xC3"), "é \xEF\xBF\xBD");
  EXPECT_EQ(xml_text("\xF0\x9F\x8C\xBE \xED\xA0\x80"),
            "\xF0\x9F\x8C\xBE \xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST(text, of_a_shell_is_one_word) {
  EXPECT_EQ(shell_text("a/b-1.toml"), "a/b-1.toml");
  EXPECT_EQ(shell_text(""), "''");
  EXPECT_EQ(shell_text("it's `x` $y"), "'it'\\''s `x` $y'");
}

TEST(text, on_a_terminal_does_nothing_to_it) {
  EXPECT_EQ(terminal_text("a\nb\x1b[31m\r\xC2\x9B\xFF"), "a\nb\\x1b[31m\\x0d\\xc2\\x9b\\xff");
}

TEST(text, that_leads_elsewhere_or_cannot_be_shown_is_no_name_of_a_file) {
  for (const char* name : {"sand", "a b'c`d`", "é", ".hidden", "-x", "a.b", "a\\b"})
    EXPECT_TRUE(is_file_name(name)) << name;
  for (const char* name : {"", ".", "..", "../x", "a/b", "/", "a..b", "a\nb", "a\tb", "\x7f",
                           "a\xC2\x85", "\xFF", "\xC0\xAF", "\xED\xA0\x80", "\xEF\xBF\xBF"})
    EXPECT_FALSE(is_file_name(name)) << name;
  EXPECT_FALSE(is_file_name(std::string_view("a\0b", 3)));
}

TEST(text, in_a_table_is_read_as_it_was_written) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "a.csv";
  const std::vector<std::string> names{"plain",      "a,b",           "say \"x\"",
                                       "two\nlines", "[in] brackets", ""};
  std::vector<std::string> columns;
  for (const std::string& name : names) columns.push_back(name + "[m]");
  std::uintmax_t length = 0;
  {
    CsvWriter table(path, columns);
    table.row({1, 2, 3, 4, 5, 6});
    length = table.length();
  }
  CsvWriter(path, columns, length).row({7, 8, 9, 10, 11, 12});
  const CsvTable table = read_csv(path);
  EXPECT_EQ(table.names, names);
  EXPECT_EQ(table["a,b"], (std::vector<double>{2, 8}));
  EXPECT_EQ(table["two\nlines"], (std::vector<double>{4, 10}));

  std::string text = "name,value\n";
  for (const std::string& name : names) text += grainlaw::core::csv_field(name) + ",1\r\n";
  std::ofstream(path, std::ios::binary) << text;
  EXPECT_EQ(read_csv_names(path), names);
  EXPECT_EQ(read_csv(path)["value"], std::vector<double>(names.size(), 1));
}

TEST(text, a_table_keeps_its_columns_whatever_they_are_called) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "table.csv";
  Table table("", {"case", "one, two", "a \"b\"[-]"});
  table.row({"first, and second", 1.0, 2.0});
  table.write(path);
  const CsvTable read = read_csv(path);
  EXPECT_EQ(read.names, (std::vector<std::string>{"case", "one, two", "a \"b\""}));
  EXPECT_EQ(read["one, two"], std::vector<double>{1});
  EXPECT_EQ(read_csv_names(path), std::vector<std::string>{"first; and second"});
}

}  // namespace
}  // namespace verification
