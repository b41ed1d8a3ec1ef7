#include "doctor/processes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace crane::doctor {
namespace {

using testing::HasSubstr;

TEST(Processes, HaveDomainAndCraneOnTheirCommandLine) {
  const auto process =
      process_from({"/usr/bin/crane_tracking", "--domain", "7", "--crane=north", "--interface", "10.0.0.5",
                    "--interface", "10.0.1.5", "--secure", "keys"});
  EXPECT_EQ(process.program, "crane_tracking");
  EXPECT_EQ(process.domain, 7U);
  EXPECT_EQ(process.crane, "north");
  EXPECT_EQ(process.interfaces, (std::vector<std::string>{"10.0.0.5", "10.0.1.5"}));
  EXPECT_TRUE(process.secure);
  EXPECT_TRUE(process.in_loop());
}

TEST(Processes, WithoutOptionsAreThoseOfTheDefaultCrane) {
  const auto process = process_from({"crane", "status"});
  EXPECT_EQ(process.crane, "crane");
  EXPECT_EQ(process.domain, 0U);
  EXPECT_EQ(process.interfaces, std::vector<std::string>{"127.0.0.1"});
  EXPECT_FALSE(process.in_loop());
  EXPECT_EQ(process_from({}).program, "");
  EXPECT_EQ(process_from({"crane_plant", "--domain"}).domain, 0U);
  EXPECT_EQ(process_from({"crane_plant", "--domain", "seven"}).domain, 0U);
}

LocalProcess tracking(int pid) {
  auto process = process_from({"crane_tracking", "--crane", "a", "--domain", "1"});
  process.pid = pid;
  return process;
}

TEST(Processes, OfOneProgramTwiceAreTwoStacks) {
  const auto found = judge_processes({tracking(11), tracking(12)}, "a", 1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].code, "process_twice");
  EXPECT_THAT(found[0].what, HasSubstr("processes 11 and 12"));
  EXPECT_TRUE(judge_processes({tracking(11), tracking(12)}, "b", 1).empty());
  EXPECT_TRUE(judge_processes({tracking(11)}, "a", 1).empty());
}

TEST(Processes, ThatAreStoppedAreReported) {
  auto stopped = tracking(11);
  stopped.stopped = true;
  const auto found = judge_processes({stopped}, "a", 1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].remedy, HasSubstr("kill -CONT 11"));
}

}  // namespace
}  // namespace crane::doctor
