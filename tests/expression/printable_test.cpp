/// Texts of other programs cannot control a terminal.
#include "crane/fields/printable.hpp"

#include <gtest/gtest.h>

#include <random>

namespace crane::fields {
namespace {

std::string shown(std::string_view text) { return printable(text); }

TEST(Printable, KeepsVisibleText) {
  for (const char* text : {"", "supervisor", "45 \xC2\xB0", "K\xC3\xA4lte \xE2\x82\xAC \xF0\x9F\x8F\x97"})
    EXPECT_EQ(shown(text), text);
}

TEST(Printable, ReplacesCharactersThatControlATerminal) {
  EXPECT_EQ(shown("\x1b[2J\x1b]0;title\x07"), "?[2J?]0;title?");
  EXPECT_EQ(shown("\x7f\b\x0e"), "???");
  EXPECT_EQ(shown("a\xC2\x9B"
                  "31mb"),
            "a??31mb")
      << "U+009B begins an escape sequence, too";
  EXPECT_EQ(shown(std::string_view{"a\0b", 3}), "a?b");
}

TEST(Printable, HasOneLine) { EXPECT_EQ(shown("HOLD\r\nsupervisor\tRUN"), "HOLD  supervisor RUN"); }

TEST(Printable, HasOneDirection) {
  EXPECT_EQ(shown("\xE2\x80\xAE"
                  "DLOH"),
            "???DLOH")
      << "U+202E";
  EXPECT_EQ(shown("\xE2\x81\xA6x\xEF\xBB\xBF\xD8\x9C"), "???x?????");
}

TEST(Printable, ReplacesInvalidUtf8) {
  EXPECT_EQ(shown("a\x80"
                  "b\xC3"),
            "a?b?");
  EXPECT_EQ(shown("\xC0\xAF"), "??") << "overlong";
  EXPECT_EQ(shown("\xED\xA0\x80"), "???") << "surrogate";
  EXPECT_EQ(shown("\xF4\x90\x80\x80\xFF"), "?????") << "beyond U+10FFFF";
}

TEST(Printable, OfRandomBytesKeepsTheirNumberAndIsIdempotent) {
  constexpr unsigned kSeed = 41;
  std::mt19937 random{kSeed};
  for (int i = 0; i < 20'000; ++i) {
    std::string text(random() % 12, ' ');
    for (auto& c : text) c = static_cast<char>(random() % 256);
    auto once = text;
    make_printable(once);
    ASSERT_EQ(once.size(), text.size());
    ASSERT_FALSE(make_printable(once)) << "seed " << kSeed << ", text " << i;
  }
}

TEST(Printable, EndsWithAWholeCharacter) {
  EXPECT_EQ(printable("5 \xC2\xB0", 3), "5 ");
  EXPECT_EQ(printable("5 \xC2\xB0", 4), "5 \xC2\xB0");
  EXPECT_EQ(printable("\x80\x80\x80", 2), "");
}

}  // namespace
}  // namespace crane::fields
