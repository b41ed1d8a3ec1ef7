// A run in real time is recorded, and replayed bit for bit in one process and as processes of both DDS
// vendors.
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "../recording/temporary_directory.hpp"
#include "program_run.hpp"
#include "running_stack.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using Arguments = std::vector<std::string>;

constexpr std::uint32_t kDomain = 94;
const auto kCrane = stack::program_directory() / "crane";

Arguments joined(Arguments first, const Arguments& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

class RecordedVendor : public testing::TestWithParam<const char*> {
 protected:
  /// Records a start, a move and a stick session, then `last`.
  void record(const Arguments& last = {}) {
    const Arguments where{"--domain", std::to_string(kDomain), "--crane", crane_name()};
    ProgramRun up{kCrane, joined({"up", "--dds", GetParam(), "--record", file_, "--no-black-box"}, where)};
    ASSERT_TRUE(up.wait_for("is up with", 60s)) << up.errors();
    const auto operate = [&](const Arguments& what) {
      const auto ended = run_program(kCrane, joined(what, where));
      ASSERT_EQ(ended.exit_code, 0) << what.front() << ": " << ended.errors;
    };
    std::this_thread::sleep_for(1500ms);  // a reset needs causes that have been inactive for a second
    operate({"reset"});
    std::this_thread::sleep_for(1100ms);
    operate({"arm"});
    operate({"move", "--trolley", "0.6", "--slew", "20deg", "--wait"});
    operate({"jog", "--slew", "-0.3", "--for", "1"});
    if (!last.empty()) operate(last);
    up.send(SIGINT);
    ASSERT_EQ(up.wait(20s), 0) << up.errors();
  }
  void expect_equal(const Arguments& how) {
    const auto ended = run_program(kCrane, joined({"replay", file_, "--json"}, how));
    SCOPED_TRACE(ended.errors + ended.output);
    ASSERT_EQ(ended.exit_code, 0);
    const auto json = nlohmann::json::parse(ended.output);
    EXPECT_TRUE(json.at("equal"));
    EXPECT_FALSE(json.contains("ends"));
    EXPECT_GT(json.at("equal_ticks"), 600) << "the start and a move take more than 6 s";
  }
  recording::TemporaryDirectory directory_;
  std::string file_ = (directory_ / "run.mcap").string();
};

TEST_P(RecordedVendor, IsReplayedInOneProcessAndAsProcessesOfBothVendors) {
  ASSERT_NO_FATAL_FAILURE(record());
  expect_equal({});
  for (const char* vendor : {"cyclone", "fastdds"})
    expect_equal({"--processes", "--domain", std::to_string(kDomain), "--dds", vendor});
}

/// The ramp of a stop begins after a time of rest on the local clock of the supervisor. A replay knows the
/// sample times only; under load, its ramp may begin one tick later.
TEST_P(RecordedVendor, KnownShortcomingUnderLoadIsReplayedThroughTheRampOfAStop) {
  ASSERT_NO_FATAL_FAILURE(record({"stop"}));
  expect_equal({});
}

INSTANTIATE_TEST_SUITE_P(Replay, RecordedVendor, testing::Values("cyclone", "fastdds"),
                         [](const auto& vendor) { return std::string{vendor.param}; });

}  // namespace
}  // namespace crane::system_test
