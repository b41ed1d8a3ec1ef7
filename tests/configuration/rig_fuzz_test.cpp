// Rig files with a random change of one line.
#include <gmock/gmock.h>

#include <fstream>
#include <random>

#include "rig_text.hpp"

namespace crane::configuration {
namespace {

/// One changed line of the file: removed, repeated, cut, with another byte or another value.
std::string spoiled(std::mt19937& random, std::vector<std::string> lines) {
  static const std::vector<std::string> kValues{
      "nan",  "-inf", "-1", "1e300", "99999999999999999999", "\"\"",
      "true", "{}",   "[]", "[1,",   "0x7fffffffffffffff",   "1979-05-27"};
  const auto below = [&random](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  std::string& line = lines[below(lines.size())];
  switch (below(5)) {
    case 0:
      line.clear();
      break;
    case 1:
      line += '\n' + line;
      break;
    case 2:
      line.resize(below(line.size() + 1));
      break;
    case 3:
      if (!line.empty()) line[below(line.size())] = static_cast<char>(below(256));
      break;
    default:
      line = line.substr(0, line.find('=') + 1) + kValues[below(kValues.size())];
      break;
  }
  std::string text;
  for (const auto& each : lines) text += each + '\n';
  return text;
}

TEST(RigFile, EitherLoadsOrNamesTheLineAfterAnyChangeOfOneLine) {
  constexpr unsigned kSeed = 20240611;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937 random(kSeed);
  std::vector<std::string> lines;
  std::ifstream stream(kTower);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  int loaded = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::string text = spoiled(random, lines);
    try {
      const Rig rig = parse_rig(text, "rig.toml");
      ASSERT_THAT(control::problems(rig.design), testing::IsEmpty()) << text;
      ++loaded;
    } catch (const ConfigurationError& error) {
      ASSERT_FALSE(error.problems().empty());
      for (const auto& problem : error.problems()) {
        ASSERT_TRUE(problem.starts_with("rig.toml:")) << problem;
        ASSERT_GT(std::stoi(problem.substr(9)), 0) << problem;
      }
    }
  }
  EXPECT_GT(loaded, 0);     // lines with comments and default values may be wrong
  EXPECT_LT(loaded, 1800);  // a change of most lines is detected
}

}  // namespace
}  // namespace crane::configuration
