/// Texts that fit a terminal.
#include "cli/terminal.hpp"

#include <gtest/gtest.h>

namespace crane::cli {
namespace {

TEST(FittedText, CountsCharactersAndNotBytes) {
  EXPECT_EQ(width_of("a▁█"), 3U);
  EXPECT_EQ(cut("▁▂▃▄", 2), "▁▂");
  EXPECT_EQ(cut("ab", 5), "ab");
  EXPECT_EQ(cut("ab", 0), "");
}

TEST(FittedText, CutsLinesToTheColumns) {
  EXPECT_EQ(fitted("abcdef\n▁▂▃▄▅▆\nxy\n", {.columns = 4, .rows = 10}), "abcd\n▁▂▃▄\nxy\n");
}

TEST(FittedText, StatesTheNumberOfOmittedLines) {
  EXPECT_EQ(fitted("1\n2\n3\n", {.columns = 50, .rows = 3}), "1\n2\n3\n");
  EXPECT_EQ(fitted("1\n2\n3\n4\n", {.columns = 50, .rows = 3}),
            "1\n2\n2 more lines: the terminal is too small\n");
  EXPECT_EQ(fitted("1\n2\n", {.columns = 6, .rows = 1}), "2 more\n");
  EXPECT_EQ(fitted("1\n2\n", {.columns = 6, .rows = 0}), "");
}

}  // namespace
}  // namespace crane::cli
