#include "crane/report/page.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "crane/files/complete_file.hpp"
#include "plots_of.hpp"

namespace crane::report {
namespace {

using testing::HasSubstr;
using testing::Not;

Page page_of(Block block) { return {.title = "t", .summary = "", .sections = {{"s", {std::move(block)}}}}; }

/// A page with all kinds of content, in which every text is `text`.
Page full_of(const std::string& text) {
  const LinePlot plot{.title = text,
                      .x_label = text,
                      .y_label = text,
                      .x = {0, 1},
                      .series = {{.name = text, .x = {}, .y = {1, 2}, .upper = {}}},
                      .group = text};
  return {.title = text,
          .summary = text,
          .sections = {{.title = text,
                        .blocks = {Paragraph{text}, Verdict{text, Tone::bad},
                                   Table{.title = text, .header = {text}, .rows = {{Cell{text}}}}, plot,
                                   Picture{.title = text, .svg = "<svg></svg>"}},
                        .folded = true}}};
}

TEST(Page, EscapesEveryText) {
  const std::string hostile = "</script><img src=x onerror='alert(1)'>&\"";
  const std::string html = to_html(full_of(hostile));
  EXPECT_THAT(html, Not(HasSubstr("<img")));
  EXPECT_THAT(html, Not(HasSubstr(hostile)));
  EXPECT_THAT(html, HasSubstr("&lt;/script&gt;&lt;img src=x onerror=&#39;alert(1)&#39;&gt;&amp;&quot;"));
  ASSERT_EQ(plots_of(html).size(), 1U);
  EXPECT_EQ(plots_of(html)[0].at("series")[0].at("name"), hostile) << "the legend shows the text as it is";
}

TEST(Page, TakesTextsThatAreNotUtf8) { EXPECT_NO_THROW((void)to_html(full_of("\xff\xfe"))); }

TEST(Page, LoadsNothingFromAnywhere) {
  const std::string html = to_html(full_of("text"));
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  for (const char* loader : {"<link", "@import", " src=", "url("}) EXPECT_THAT(html, Not(HasSubstr(loader)));
}

TEST(Page, SamePageSameBytes) { EXPECT_EQ(to_html(full_of("text")), to_html(full_of("text"))); }

TEST(Page, AlignsNumbersRightAndTextsLeft) {
  const auto cell = [](const std::string& text) {
    const std::string html = to_html(page_of(Table{.title = "", .header = {"h"}, .rows = {{Cell{text}}}}));
    const auto at = html.find("<td class=\"") + 11;
    return html.substr(at, html.find('"', at) - at);
  };
  for (const char* text : {"1.5", "-0.2 [-0.3, -0.1]", "-", "+3", "14.3 %"})
    EXPECT_EQ(cell(text), "neutral number");
  for (const char* text : {"delayed_1", "-inf", "", "CAUSE_SWING"}) EXPECT_EQ(cell(text), "neutral");
}

TEST(Page, WritesNumbersWithTheirInterval) {
  EXPECT_EQ(with_interval(0.2714, 0.265, 0.2771, 3).text, "0.271 [0.265, 0.277]");
  EXPECT_EQ(number(-1.005, 1).text, "-1.0");
  EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN(), 3).text, "-");
  EXPECT_EQ(number(1e300, 0).text.size(), 301U);
}

TEST(Page, RefusesAPictureThatIsNotSvg) {
  EXPECT_THROW((void)to_html(page_of(Picture{.title = "p", .svg = "<?xml?>"})), std::invalid_argument);
}

TEST(Page, IsWrittenUnchanged) {
  const auto file = std::filesystem::path{testing::TempDir()} / "page_test.html";
  write_html(file, full_of("text"));
  std::ostringstream read;
  read << std::ifstream{file, std::ios::binary}.rdbuf();
  EXPECT_EQ(read.str(), to_html(full_of("text")));
  std::filesystem::remove(file);
}

TEST(Page, NamesTheFileThatCannotBeWritten) {
  try {
    write_html("/nowhere/page.html", full_of("text"));
    FAIL();
  } catch (const files::WriteError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nowhere/page.html"));
  }
}

}  // namespace
}  // namespace crane::report
