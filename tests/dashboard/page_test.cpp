/// Texts of the bus (names, events, remedies) reach the page of the dashboard. The page shows them as text:
/// its scripts contain nothing that interprets a string as markup or as a program.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace crane::dashboard {
namespace {

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in{file};
  return {std::istreambuf_iterator<char>{in}, {}};
}

TEST(Page, NeverInterpretsATextAsMarkupOrAsAProgram) {
  int scripts = 0;
  for (const auto& entry : std::filesystem::directory_iterator{CRANE_DASHBOARD_PAGE}) {
    if (entry.path().extension() != ".js") continue;
    ++scripts;
    const auto script = content_of(entry.path());
    for (const char* sink :
         {"innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "DOMParser", "srcdoc", "setHTML",
          "createContextualFragment", "eval(", "new Function", "javascript:", "setTimeout(\"", "onerror="})
      EXPECT_EQ(script.find(sink), std::string::npos) << entry.path() << " contains " << sink;
  }
  EXPECT_GT(scripts, 10);
}

TEST(Page, HasNoScriptInItsMarkup) {
  const auto page = content_of(std::filesystem::path{CRANE_DASHBOARD_PAGE} / "index.html");
  ASSERT_FALSE(page.empty());
  for (auto at = page.find("<script"); at != std::string::npos; at = page.find("<script", at + 1))
    EXPECT_EQ(page.substr(page.find('>', at) + 1, 9), "</script>") << page.substr(at, 60);
  for (const char* handler : {" onclick=", " onload=", " onerror=", "javascript:"})
    EXPECT_EQ(page.find(handler), std::string::npos) << handler;
}

}  // namespace
}  // namespace crane::dashboard
