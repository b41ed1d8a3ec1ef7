/// Texts of the bus (names, events, remedies) reach the page of the dashboard. The page shows them as text:
/// its scripts contain nothing that interprets a string as markup or as a program.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "crane/plant/coordinates.hpp"
#include "dashboard/page_files.hpp"

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

TEST(Page, IsServedWithEveryModuleThatItsScriptsImport) {
  const std::regex import_of_page{R"re(from "\./([a-z_]+\.js)")re"};
  int imports = 0;
  for (const PageFile& file : page_files()) {
    if (file.media_type != "text/javascript" || file.path.starts_with("/vendor")) continue;
    const std::string script{file.bytes};
    for (std::sregex_iterator it{script.begin(), script.end(), import_of_page}, end; it != end; ++it) {
      ++imports;
      EXPECT_NE(find_page_file("/" + (*it)[1].str()), nullptr) << file.path << " imports " << (*it)[1];
    }
  }
  EXPECT_GT(imports, 20);
}

TEST(Page, ReceivesTheTableOfTheCoordinates) {
  const PageFile* file = find_page_file("/coordinates.js");
  ASSERT_NE(file, nullptr);
  const auto begin = file->bytes.find('['), end = file->bytes.rfind(']');
  ASSERT_LT(begin, end);
  const auto table = nlohmann::json::parse(file->bytes.substr(begin, end - begin + 1));
  ASSERT_EQ(table.size(), plant::kCoordinateCount);
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_EQ(table[i]["name"], plant::kCoordinates[i].name);
    EXPECT_EQ(table[i]["column"], plant::kCoordinates[i].column);
    EXPECT_EQ(table[i]["driven"], i < plant::kAxes);
  }
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
