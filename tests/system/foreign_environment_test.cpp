/// The `crane` command in the environment of another program that uses the same middleware.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

#include "../recording/temporary_directory.hpp"
#include "program_run.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kForeignDomain = 63;

/// Environment of another program with the same middleware: configurations that lead to other ports and to a
/// Discovery Server that does not exist.
class ForeignEnvironment {
 public:
  ForeignEnvironment(const std::string& profiles, const std::string& variables) {
    for (const auto& [name, value] : std::initializer_list<std::pair<const char*, std::string>>{
             {"CYCLONEDDS_URI",
              "<CycloneDDS><Domain><Discovery><Ports><Base>12000</Base></Ports></Discovery></Domain></"
              "CycloneDDS>"},
             {"ROS_DISCOVERY_SERVER", "127.0.0.1:11811"},
             {"FASTDDS_ENVIRONMENT_FILE", variables},
             {"FASTRTPS_DEFAULT_PROFILES_FILE", profiles}}) {
      ::setenv(name, value.c_str(), 1);
      names_.emplace_back(name);
    }
  }
  ~ForeignEnvironment() {
    for (const auto& name : names_) ::unsetenv(name.c_str());
  }
  ForeignEnvironment(const ForeignEnvironment&) = delete;
  ForeignEnvironment& operator=(const ForeignEnvironment&) = delete;

 private:
  std::vector<std::string> names_;
};

class StartOnVendor : public testing::TestWithParam<const char*> {
 protected:
  void TearDown() override { EXPECT_THAT(processes_with(crane_name()), testing::IsEmpty()); }
  [[nodiscard]] static std::vector<std::string> on_vendor(const std::string& command) {
    return {command,   "--dds",     GetParam(), "--domain", std::to_string(kForeignDomain),
            "--crane", crane_name()};
  }
  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const {
    recording::put_contents(directory_ / name, text);
    return (directory_ / name).string();
  }
  /// Sets the environment of programs that start later.
  [[nodiscard]] ForeignEnvironment foreign_environment() const {
    return ForeignEnvironment{
        file("profiles.xml",
             R"(<dds><profiles><participant profile_name="a" is_default_profile="true"><rtps><port>)"
             "<portBase>12000</portBase></port></rtps></participant></profiles></dds>"),
        file("variables.json", R"({"environment_variables": {"ROS_DISCOVERY_SERVER": "127.0.0.1:11811"}})")};
  }

  recording::TemporaryDirectory directory_;
};

TEST_P(StartOnVendor, OfAStackInAForeignEnvironmentSucceeds) {
  const auto environment = foreign_environment();
  ProgramRun up{stack::program_directory() / "crane", on_vendor("up")};
  EXPECT_TRUE(up.wait_for("is up with", 20s)) << up.errors();
  up.send(SIGINT);
  EXPECT_TRUE(up.wait(10s));
}

TEST_P(StartOnVendor, OfAnOperatorToolInAForeignEnvironmentStopsTheCrane) {
  ProgramRun up{stack::program_directory() / "crane", on_vendor("up")};
  ASSERT_TRUE(up.wait_for("is up with", 20s)) << up.errors();
  const auto environment = foreign_environment();
  const auto estop = run_program(stack::program_directory() / "crane", on_vendor("estop"));
  EXPECT_EQ(estop.exit_code, 0) << estop.errors;
  up.send(SIGINT);
  EXPECT_TRUE(up.wait(10s));
}

INSTANTIATE_TEST_SUITE_P(Vendors, StartOnVendor, testing::Values("cyclone", "fastdds"),
                         [](const auto& test) { return std::string{test.param}; });

}  // namespace
}  // namespace crane::system_test
