#pragma once
/// The `crane` command, started for a crane of the test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "../recording/temporary_directory.hpp"
#include "program_run.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"

namespace crane::system_test {

inline constexpr std::uint32_t kDomain = 63;
inline constexpr int kFailed = 1;    ///< exit code
inline constexpr int kBadInput = 2;  ///< exit code

/// The crane of this test. No process of it remains after a test.
class Start : public testing::Test {
 protected:
  void TearDown() override { EXPECT_THAT(processes_with(crane_name()), testing::IsEmpty()); }

  /// The `crane` command for the crane of this test.
  [[nodiscard]] static std::vector<std::string> on_this_crane(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--domain", std::to_string(kDomain), "--crane", crane_name()});
    return arguments;
  }
  [[nodiscard]] static Ended crane(const std::vector<std::string>& arguments) {
    return run_program(stack::program_directory() / "crane", on_this_crane(arguments));
  }
  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const {
    recording::put_contents(directory_ / name, text);
    return (directory_ / name).string();
  }
  /// A rig file that extends the tower crane by these lines.
  [[nodiscard]] std::string rig_file(const std::string& lines) const {
    return file("rig.toml",
                "extends = \"" + stack::find_rig("virginia_tech_tower").string() + "\"\n" + lines);
  }
  [[nodiscard]] std::string out() const { return (directory_ / "out").string(); }

  recording::TemporaryDirectory directory_;
};

inline std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace crane::system_test
