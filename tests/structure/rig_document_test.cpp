// The document shows the fields of a rig file that the code declares.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "crane/configuration/rig_document.hpp"

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

}  // namespace
}  // namespace crane::configuration
