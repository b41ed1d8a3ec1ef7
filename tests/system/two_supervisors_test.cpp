/// Two supervisors of one crane start at the same moment, with equal and different DDS vendors. One of them
/// ends and names the other. The crane does not move while both run, and obeys the remaining one afterwards.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <random>

#include "program_run.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kDomain = 81;
constexpr unsigned kSeed = 20271127;
/// In the first trials, neither one can find the other before its own first sample; in the last one, the
/// search at the start finds it.
constexpr std::array kLongestLead_ms{0, 0, 0, 20, 300};
constexpr const char* kRig = "virginia_tech_tower";

struct Pair {
  const char* first;
  const char* second;
};

class TwoSupervisors : public testing::TestWithParam<Pair> {
 protected:
  TwoSupervisors() {
    options_.bus.domain = kDomain;
    options_.bus.crane = crane_name();
    options_.rig = stack::find_rig(kRig).string();
    auto specs = stack::simulated_stack();
    std::erase_if(specs, [](const auto& spec) { return spec.name == "supervisor"; });
    stack::launch(others_, specs, options_);
    bus_.emplace(runtime::bus_options(options_.bus, "system_test", crane_SOURCE_OPERATOR, 0));
    observer_.emplace(*bus_);
  }
  [[nodiscard]] ProgramRun supervisor(const char* vendor) const {
    return {stack::program_directory() / "crane_supervisor",
            {"--rig", options_.rig, "--domain", std::to_string(kDomain), "--crane", crane_name(), "--dds",
             vendor, "--ledger",
             "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(options_.ledger->descriptor())}};
  }
  struct Outcome {
    ProgramRun& ended;
    ProgramRun& survivor;
    int exit_code;
  };
  /// Nothing when both run after 8 s. Fails when both have ended.
  [[nodiscard]] static std::optional<Outcome> end_of_one(ProgramRun& a, ProgramRun& b) {
    const auto give_up = std::chrono::steady_clock::now() + 8s;
    while (std::chrono::steady_clock::now() < give_up)
      for (auto* one : {&a, &b})
        if (const auto code = one->wait(20ms)) {
          auto& other = one == &a ? b : a;
          if (other.wait(1s)) break;
          return Outcome{*one, other, *code};
        }
    ADD_FAILURE() << "both have ended, or both run 8 s after their start";
    return std::nullopt;
  }
  void expect_no_motion() const {
    for (const auto& state : observer_->states())
      for (std::size_t i = 0; i < 3; ++i)
        ASSERT_TRUE(state.applied_v[i] == 0 && state.brake_closed[i]) << "tick " << state.header.tick;
  }

  stack::LaunchOptions options_;
  stack::ChildProcesses others_;
  std::optional<bus::Bus> bus_;
  std::optional<Observer> observer_;
};

TEST_P(TwoSupervisors, ThatStartTogetherLeaveOneThatTheOperatorCanUse) {
  std::mt19937 random{kSeed};
  for (const int longest_ms : kLongestLead_ms) {
    const std::chrono::milliseconds lead{std::uniform_int_distribution{0, longest_ms}(random)};
    observer_->forget();
    auto first = supervisor(GetParam().first);
    EXPECT_FALSE(first.wait(lead)) << first.errors();
    auto second = supervisor(GetParam().second);
    const auto begun = std::chrono::steady_clock::now();
    const auto outcome = end_of_one(first, second);
    const auto took =
        std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - begun);
    ASSERT_TRUE(outcome) << lead.count() << " ms apart, seed " << kSeed;
    auto& [ended, survivor, exit_code] = *outcome;
    EXPECT_EQ(exit_code, 1);
    std::cout << GetParam().first << " and " << GetParam().second << ", " << lead.count()
              << " ms apart, seed " << kSeed << ": the " << (&ended == &first ? "first" : "second")
              << " ended within " << took.count() - 1000 << " ms\n  " << ended.errors();
    EXPECT_THAT(ended.errors(), testing::AnyOf(testing::HasSubstr("another process already writes"),
                                               testing::HasSubstr("another supervisor")));
    observer_->take();
    expect_no_motion();
    experiments::RealtimeSession session{*bus_, [this] { observer_->take(); }};
    ASSERT_NO_THROW(session.arm());
    ASSERT_NO_THROW(session.request({.kind = crane_REQUEST_DISARM}, "disarm"));
    const auto give_up = std::chrono::steady_clock::now() + 10s;
    while (session.status()->state != crane_STATE_LOCKED && std::chrono::steady_clock::now() < give_up)
      session.wait(20ms);
    ASSERT_EQ(session.status()->state, crane_STATE_LOCKED);
    survivor.send(SIGTERM);
    EXPECT_EQ(survivor.wait(5s), 0) << survivor.errors();
    session.wait(1s);
  }
}

INSTANTIATE_TEST_SUITE_P(OfBothVendors, TwoSupervisors,
                         testing::Values(Pair{"cyclone", "cyclone"}, Pair{"fastdds", "fastdds"},
                                         Pair{"cyclone", "fastdds"}),
                         [](const auto& pair) {
                           return std::string{pair.param.first} + "_" + pair.param.second;
                         });

}  // namespace
}  // namespace crane::system_test
