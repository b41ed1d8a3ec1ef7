// The documents show the fields of a rig file and the terms of the model that the code declares.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "crane/configuration/rig_document.hpp"
#include "crane/plant/term.hpp"

namespace crane::configuration {
namespace {

std::string document(const char* name) {
  std::ifstream in{std::string{CRANE_SOURCE_DIRECTORY} + "/docs/" + name};
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Documents, ShowTheFieldsOfARigFile) {
  const auto shown = document("rig_file.md"), right = with_section_tables(shown);
  const auto copy = std::filesystem::path{testing::TempDir()} / "rig_file.md";
  std::ofstream{copy} << right;
  EXPECT_EQ(shown, right) << "put " << copy << " there";
}

TEST(Documents, HaveTheEquationOfEveryTerm) {
  const auto text = document("equations.md");
  const auto section = text.substr(text.find("### Terms"));
  std::vector<std::string> shown, registered;
  const std::regex row{"\n\\| `([a-z_]+)` \\| (parameters|command|drive|load|structure|sensor) \\|"};
  for (std::sregex_iterator it{section.begin(), section.end(), row}, end; it != end; ++it)
    shown.push_back((*it)[1]);
  for (const auto& kind : plant::term_kinds()) registered.emplace_back(kind.name);
  EXPECT_EQ(shown, registered);
}

}  // namespace
}  // namespace crane::configuration
