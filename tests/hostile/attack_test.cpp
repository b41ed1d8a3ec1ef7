/// A foreign program with the bus of this project, or with a plain DDS writer, joins before, during and after
/// the run of a stack. A LOCKED crane must not move, and only the planner may steer an armed crane.
#include <dds/dds.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <functional>
#include <iostream>
#include <limits>

#include "../system/program_run.hpp"
#include "../system/running_stack.hpp"
#include "crane/bus/seal.hpp"
#include "false_supervisor.hpp"
#include "stack/data_files.hpp"

namespace crane::hostile {
namespace {

using namespace std::chrono_literals;
using system_test::RunningStack;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::uint32_t kDomain = 79;
constexpr double kStill_m = 0.01;  ///< motion of an axis in HOLD by swing and control

void open_and_push(msg::Command& command, std::uint64_t tick) {
  command.header.tick = tick;
  for (std::size_t i = 0; i < 3; ++i) {
    command.drive_v[i] = 5;
    command.brake_release[i] = true;
  }
  command.watchdog_permission = true;
}

runtime::BusOptions on_this_crane() {
  runtime::BusOptions options;
  options.domain = kDomain;
  options.crane = system_test::crane_name();
  return options;
}

void expect_nothing_moved(const std::vector<msg::State>& states) {
  ASSERT_GT(states.size(), 50U);
  for (const auto& state : states)
    for (std::size_t i = 0; i < 3; ++i)
      ASSERT_TRUE(state.applied_v[i] == 0 && state.brake_closed[i]) << "tick " << state.header.tick;
  EXPECT_EQ(states.front().trolley_position_m, states.back().trolley_position_m);
}

TEST(Attack, BeforeTheStackStartsIsNamedAndTheStackRefuses) {
  FalseSupervisor stranger{on_this_crane()};
  const auto ended = system_test::run_program(
      stack::program_directory() / "crane",
      {"up", "--domain", std::to_string(kDomain), "--crane", system_test::crane_name()});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.errors, AllOf(HasSubstr("already writes crane/command"), HasSubstr("--domain")));
}

TEST(Attack, WhileTheBridgeWaitsForItsSupervisorMovesNothing) {
  FalseSupervisor stranger{on_this_crane()};
  stack::ChildProcesses children;
  auto arguments = runtime::arguments(on_this_crane());
  arguments.insert(arguments.end(),
                   {"--rig", stack::find_rig("virginia_tech_tower").string(), "--priority", "0"});
  children.start("plant", "crane_plant", arguments);
  const auto end = std::chrono::steady_clock::now() + 5s;
  while (stranger.seen().size() < 150 && std::chrono::steady_clock::now() < end) stranger.speak();
  expect_nothing_moved(stranger.seen());
}

class AttackOnAStack : public testing::Test {
 protected:
  [[nodiscard]] bool supervisor_is(crane_SupervisorState state) {
    const auto& statuses = stack_.observer().statuses();
    return !statuses.empty() && statuses.back().state == state;
  }
  void wait_for(crane_SupervisorState state) {
    ASSERT_TRUE(stack_.until([&] { return supervisor_is(state); }, 8s));
    stack_.forget();
  }
  void attack_for(std::chrono::milliseconds duration, const std::function<void()>& attack) {
    (void)stack_.until(
        [&] {
          attack();
          return false;
        },
        duration);
  }
  [[nodiscard]] std::uint64_t tick() { return stack_.session().state()->header.tick; }

  RunningStack stack_{kDomain, "virginia_tech_tower"};
};

TEST_F(AttackOnAStack, AfterTheSupervisorDiedMovesNothingAndTheNextSupervisorIsObeyed) {
  stack_.session().arm();
  stack_.send("supervisor", SIGKILL);
  {
    stack_.listen(500ms);  // the crane has stopped by then
    stack_.forget();
    FalseSupervisor stranger{on_this_crane()};
    attack_for(1500ms, [&] { stranger.speak(); });
    expect_nothing_moved(stack_.observer().states());
    stack_.start_again("supervisor");  // it detects the foreign writer and refuses to start
    attack_for(1500ms, [&] { stranger.speak(); });
    expect_nothing_moved(stack_.observer().states());
  }
  stack_.start_again("supervisor");
  EXPECT_TRUE(stack_.until([&] { return supervisor_is(crane_STATE_LOCKED); }, 8s));
}

TEST_F(AttackOnAStack, OnALockedCraneWithRecordedCommandsMovesNothing) {
  stack_.session().arm();
  stack_.session().request(
      {.kind = crane_REQUEST_MOVE, .selected = {true, false, false}, .target = {0.8, 0, 0}}, "move");
  stack_.listen(1s);
  const auto recorded = stack_.observer().commands();
  ASSERT_TRUE(
      std::any_of(recorded.begin(), recorded.end(), [](const auto& c) { return c.brake_release[0]; }));
  stack_.session().request({.kind = crane_REQUEST_ESTOP}, "estop");
  stack_.listen(500ms);
  stack_.forget();
  FalseSupervisor stranger{on_this_crane(), recorded.front().header.epoch};
  std::size_t next = 0;
  attack_for(1500ms, [&] {
    for (const bool as_recorded : {true, false}) {
      auto command = recorded[next++ % recorded.size()];
      if (!as_recorded) command.header.tick = tick();
      (void)stranger.commands().publish(command);
    }
  });
  expect_nothing_moved(stack_.observer().states());
}

TEST_F(AttackOnAStack, WithTheLargestTickAndStartUpNumberHasNoLastingEffect) {
  wait_for(crane_STATE_LOCKED);
  {
    FalseSupervisor stranger{on_this_crane(), std::numeric_limits<std::uint32_t>::max()};
    msg::Command command{};
    open_and_push(command, std::numeric_limits<std::uint64_t>::max());
    attack_for(700ms, [&] { (void)stranger.commands().publish(command); });
  }
  expect_nothing_moved(stack_.observer().states());
  EXPECT_NO_THROW(stack_.session().arm());
}

TEST_F(AttackOnAStack, OfAFloodOfRequestsLeavesTheLoopAloneAndAStopIsObeyed) {
  stack_.session().arm();
  bus::Bus bus{runtime::bus_options(on_this_crane(), "stranger", crane_SOURCE_OPERATOR, 3)};
  auto requests = bus.publisher(topics::request);
  std::uint64_t sent = 0;
  const auto flood = [&] {
    for (int i = 0; i < 100; ++i) {
      msg::Request request{};
      request.id = ++sent;
      request.kind = crane_REQUEST_MOVE;
      request.selected[0] = true;
      request.target[0] = 99;  // refused
      request.apply_tick = i % 2 == 0 ? 0 : tick() + 10'000;
      (void)requests.publish(request);
    }
  };
  stack_.forget();
  attack_for(2s, flood);
  std::cout << sent << " requests in 2 s\n";
  EXPECT_TRUE(supervisor_is(crane_STATE_HOLD));
  EXPECT_NEAR(stack_.observer().states().front().trolley_position_m,
              stack_.observer().states().back().trolley_position_m, kStill_m);
  EXPECT_NO_THROW(stack_.session().request_with_patience({.kind = crane_REQUEST_ESTOP}, "estop"));
}

/// A writer of crane/command that no bus of this project would create.
struct Bare {
  const char* name;
  std::string partition;  ///< empty: the partition of the crane
  bool exclusive = false;
  bool disposes = false, unregisters = false;
  bool is_second_writer = true;  ///< true: the crane must stop; false: the crane must not react
};
std::ostream& operator<<(std::ostream& out, const Bare& bare) { return out << bare.name; }

class BareWriter {
 public:
  explicit BareWriter(const Bare& bare)
      : bare_{bare}, participant_{dds_create_participant(kDomain, nullptr, nullptr)} {
    dds_qos_t* qos = dds_create_qos();
    const std::string crane = bare.partition.empty() ? system_test::crane_name() : bare.partition;
    const char* partition = crane.c_str();
    dds_qset_partition(qos, 1, &partition);
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(10));
    const dds_data_representation_id_t plain_cdr = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos, 1, &plain_cdr);
    if (bare.exclusive) {
      dds_qset_ownership(qos, DDS_OWNERSHIP_EXCLUSIVE);
      dds_qset_ownership_strength(qos, 1000);
    }
    const auto& topic = topics::command.description;
    topic_ =
        dds_create_topic(participant_, topic.descriptor, std::string{topic.name}.c_str(), nullptr, nullptr);
    const auto publisher = dds_create_publisher(participant_, qos, nullptr);
    writer_ = dds_create_writer(publisher, topic_, qos, nullptr);
    dds_delete_qos(qos);
  }
  ~BareWriter() { dds_delete(participant_); }
  BareWriter(const BareWriter&) = delete;
  BareWriter& operator=(const BareWriter&) = delete;

  void speak(const msg::Command& last) {
    auto command = last;
    open_and_push(command, last.header.tick + 1);
    bus::seal(topics::command.description, &command, last.header.source, last.header.epoch);
    if (bare_.disposes)
      dds_dispose(writer_, &command);
    else
      dds_write(writer_, &command);
    if (bare_.unregisters) dds_unregister_instance(writer_, &command);
  }

 private:
  Bare bare_;
  dds_entity_t participant_, topic_ = 0, writer_ = 0;
};

class BareAttack : public AttackOnAStack, public testing::WithParamInterface<Bare> {};

TEST_P(BareAttack, DoesNotSteerAnArmedCrane) {
  stack_.session().arm();
  stack_.forget();
  BareWriter stranger{GetParam()};
  ASSERT_TRUE(stack_.until([&] { return !stack_.observer().commands().empty(); }, 1s));
  attack_for(700ms, [&] { stranger.speak(stack_.observer().commands().back()); });
  const auto& states = stack_.observer().states();
  EXPECT_NEAR(states.front().trolley_position_m, states.back().trolley_position_m, kStill_m);
  if (!GetParam().is_second_writer) {
    EXPECT_TRUE(supervisor_is(crane_STATE_HOLD));
    return;
  }
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_TRUE(states.back().brake_closed[i] && states.back().applied_v[i] == 0);
}

INSTANTIATE_TEST_SUITE_P(Writers, BareAttack,
                         testing::Values(Bare{"same_crane", ""}, Bare{"every_crane", "*"},
                                         Bare{"another_crane", "another", false, false, false, false},
                                         Bare{"exclusive_owner", "", true, false, false, false},
                                         Bare{"disposes", "", false, true},
                                         Bare{"unregisters", "", false, false, true}),
                         [](const auto& test) { return std::string{test.param.name}; });

}  // namespace
}  // namespace crane::hostile
