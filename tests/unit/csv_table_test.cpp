// Comma-separated values as RFC 4180 has them.
#include "io/csv_table.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace grainlaw::core {
namespace {

std::vector<std::vector<std::string>> records_of(const std::string& text) {
  CsvRecords records(text);
  std::vector<std::vector<std::string>> all;
  for (std::vector<std::string> fields; records.next(fields);) all.push_back(fields);
  return all;
}

using Records = std::vector<std::vector<std::string>>;

TEST(csv_table, quoted_fields_hold_commas_quotes_and_line_breaks) {
  EXPECT_EQ(records_of("a,\"b,c\",\"d \"\"e\"\"\"\r\n\"f\ng\",,h"),
            (Records{{"a", "b,c", "d \"e\""}, {"f\ng", "", "h"}}));
}

TEST(csv_table, last_line_may_end_without_a_break) {
  EXPECT_EQ(records_of("a,b\n1,2"), (Records{{"a", "b"}, {"1", "2"}}));
  EXPECT_EQ(records_of("a\r"), (Records{{"a"}}));
  EXPECT_TRUE(records_of("").empty());
}

TEST(csv_table, lines_are_counted_through_quoted_breaks) {
  CsvTable<2> table("t.csv", "x,note\n1,\"two\nlines\"\n2,\n", {"x", "note"});
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.text(1), "two\nlines");
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.line(), 4U);
  EXPECT_FALSE(table.next());
}

TEST(csv_table, wrong_files_are_refused_with_their_line) {
  const auto refusal = [](const std::string& text) {
    try {
      CsvTable<2> table("t.csv", text, {"x", "y"});
      while (table.next()) static_cast<void>(table.real(0));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(""), "t.csv:1: the file is empty, expected a header line");
  EXPECT_EQ(refusal("x,y,x\n"), "t.csv:1: column 'x' stands twice");
  EXPECT_EQ(refusal("x,y\n1,2\n\n3\n"), "t.csv:4: fewer fields than the header has columns");
  EXPECT_EQ(refusal("x,y\n1,2,3\n"), "t.csv:2: more fields than the header has columns");
  EXPECT_EQ(refusal("x,y\n1,\"2\n"), "t.csv:2: a quote is not closed");
  EXPECT_EQ(refusal("x,y\n1e,2\n"), "t.csv:2: column 'x': found '1e', expected a finite number");
  EXPECT_EQ(refusal(std::string("x,y\n1\0,2\n", 9)), "t.csv: not a text file");
}

TEST(csv_table, headers_may_name_the_unit_of_a_column_and_no_other) {
  const auto refusal = [](const std::string& text) {
    try {
      CsvTable<2> table("t.csv", text, {"x[m]", "n"});
      table.require(0, 2);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal("x,n\n"), "");
  EXPECT_EQ(refusal("x [m],n\n"), "");
  EXPECT_EQ(
      refusal("x[mm],n\n"),
      "t.csv:1: column 'x': found the unit [mm], expected m; grainlaw import brings others to SI");
  EXPECT_EQ(refusal("x,n[1]\n"),
            "t.csv:1: column 'n': found the unit [1], expected none; grainlaw import brings others "
            "to SI");
  EXPECT_EQ(refusal("x[m],n,x\n"), "t.csv:1: column 'x' stands twice");
}

}  // namespace
}  // namespace grainlaw::core
