// docs/rig_file.md shows the fields that the tables in the code declare.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "crane/configuration/rig_document.hpp"

namespace crane::configuration {
namespace {

TEST(Documents, ShowTheFieldsOfARigFile) {
  std::ifstream in{std::string{CRANE_SOURCE_DIRECTORY} + "/docs/rig_file.md"};
  std::stringstream text;
  text << in.rdbuf();
  const auto right = with_section_tables(text.str());
  const auto copy = std::filesystem::path{testing::TempDir()} / "rig_file.md";
  std::ofstream{copy} << right;
  EXPECT_EQ(text.str(), right) << "put " << copy << " there";
}

}  // namespace
}  // namespace crane::configuration
