/// A start beside programs of the same crane: another stack, and a program of another release.
#include <csignal>

#include "crane/bus/bus.hpp"
#include "start_fixture.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

/// A program of another release for the same crane.
bus::Bus program_of_another_version(bus::Vendor vendor) {
  return bus::Bus{{.vendor = vendor,
                   .domain = kDomain,
                   .crane = crane_name(),
                   .participant = "crane_supervisor",
                   .source = crane_SOURCE_SUPERVISOR,
                   .epoch = 7,
                   .messages_version = crane_MESSAGES_VERSION + 1}};
}

TEST_F(Start, BesideAProgramWithMessagesOfAnotherVersionIsRefusedAndBothVersionsAreNamed) {
  const auto own = std::to_string(crane_MESSAGES_VERSION), other = std::to_string(crane_MESSAGES_VERSION + 1);
  for (const auto vendor : {bus::Vendor::cyclone, bus::Vendor::fastdds}) {
    const auto stranger = program_of_another_version(vendor);
    const auto plant = run_program(stack::program_directory() / "crane_plant",
                                   on_this_crane({"--rig", stack::find_rig("virginia_tech_tower").string()}));
    EXPECT_EQ(plant.exit_code, kFailed);
    EXPECT_THAT(plant.errors, HasSubstr("crane_supervisor has messages of version " + other +
                                        ", this program has version " + own));
    EXPECT_EQ(lines_in(plant.errors), 1U) << plant.errors;
    const auto status = crane({"status"});
    EXPECT_EQ(status.exit_code, kFailed);
    EXPECT_THAT(status.errors, HasSubstr("crane_supervisor has messages of version " + other));
  }
}

class StartOfASecond : public Start {
 protected:
  void SetUp() override { ASSERT_TRUE(first_.wait_for("is up with", 20s)) << first_.errors(); }
  void TearDown() override {
    first_.send(SIGINT);
    EXPECT_EQ(first_.wait(10s), 0) << first_.errors();
    Start::TearDown();
  }
  /// The first stack continues unchanged, with the same processes.
  void expect_only_the_first(const std::vector<pid_t>& before) const {
    EXPECT_EQ(processes_with(crane_name()), before);
    EXPECT_THAT(first_.errors(), IsEmpty());
  }
  ProgramRun first_{stack::program_directory() / "crane", on_this_crane({"up"})};
};

TEST_F(StartOfASecond, PlantOnTheSameCraneIsRefused) {
  const auto before = processes_with(crane_name());
  const auto ended = run_program(stack::program_directory() / "crane_plant",
                                 on_this_crane({"--rig", stack::find_rig("virginia_tech_tower").string()}));
  EXPECT_EQ(ended.exit_code, kFailed);
  EXPECT_THAT(ended.errors,
              AllOf(HasSubstr("another process already writes crane/state of crane '" + crane_name()),
                    HasSubstr("stop that stack first, or choose another --crane or --domain")));
  EXPECT_EQ(lines_in(ended.errors), 1U) << ended.errors;
  expect_only_the_first(before);
}

TEST_F(StartOfASecond, StackOnTheSameCraneIsRefused) {
  const auto before = processes_with(crane_name());
  const auto ended = crane({"up"});
  EXPECT_EQ(ended.exit_code, kFailed);
  EXPECT_THAT(ended.errors,
              AllOf(testing::ContainsRegex("\\(crane_supervisor, pid [0-9]+ on [^,]+, [0-9a-f]+\\): "),
                    HasSubstr("choose another --crane or --domain")));
  expect_only_the_first(before);
}

TEST_F(StartOfASecond, RecordingOnAFullDiskEndsWithoutAnEffectOnTheCrane) {
  const auto before = processes_with(crane_name());
  const auto ended = crane({"record", "/dev/full", "--force", "--duration", "20"});
  EXPECT_EQ(ended.exit_code, kFailed);
  EXPECT_THAT(ended.errors, HasSubstr("/dev/full: cannot write: No space left on device"));
  EXPECT_EQ(lines_in(ended.errors), 1U) << ended.errors;
  expect_only_the_first(before);
}

TEST_F(StartOfASecond, CraneBesideTheFirstIsNotRefused) {
  auto arguments = on_this_crane({"up"});
  arguments.back() += "_b";
  ProgramRun second{stack::program_directory() / "crane", arguments};
  EXPECT_TRUE(second.wait_for("is up with", 20s)) << second.errors();
  second.send(SIGTERM);
  EXPECT_EQ(second.wait(10s), 0) << second.errors();
}

}  // namespace
}  // namespace crane::system_test
