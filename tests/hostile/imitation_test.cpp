/// Forged RTPS packets under the identifiers of processes. Permitted without keys: the crane stops; without
/// the ledger of the stack also: it moves within the limits of LastLine. Forbidden: any effect with keys.
#include "../recording/temporary_directory.hpp"
#include "crane/security/keys.hpp"
#include "discovery_attack.hpp"
#include "false_commands.hpp"
#include "false_supervisor.hpp"
#include "stack/operator_client.hpp"

namespace crane::hostile {
namespace {

/// A HEARTBEAT makes the supervisor skip all samples of an operator's writer. Its repetitions arrive.
TEST_F(DiscoveryAttack, ThatSilencesAnOperatorDoesNotSilenceItsRepetitions) {
  stack_->session().arm();
  bus::Bus bus{runtime::bus_options(stack_->bus_options(), "operator", crane_SOURCE_OPERATOR, 5)};
  stack::OperatorClient client{bus, "operator", experiments::unique_first_id()};
  const auto connected = [&] { return client.listeners() >= 2 && client.answerers() >= 2; };
  ASSERT_TRUE(stack_->until(connected, 5s));
  const auto answers = [&](crane_RequestKind kind) {
    const auto id = client.send({.kind = kind});
    return stack_->until(
        [&] {
          client.receive();
          return client.take_reply(id, crane_SOURCE_SUPERVISOR).has_value();
        },
        1s);
  };
  // A move without an axis is refused: it shows the writer to the attacker.
  std::optional<Packet> request;
  Ear ear;
  const auto own = ports("supervisor");
  ASSERT_TRUE(answers(crane_REQUEST_MOVE));
  while (!request)
    if (auto packet = ear.next(100ms); packet && own.contains(packet->port())) {
      if (find(packet->message, topics::request)) request = packet;
    } else if (!packet) {
      ASSERT_TRUE(answers(crane_REQUEST_MOVE));
    }
  const auto found = find(request->message, topics::request).value();
  const auto writer = entities_of(request->message, found.data).writer;
  send_to("supervisor", heartbeat(prefix_of(request->message), writer, 1'000'000));
  stack_->listen(50ms);
  EXPECT_FALSE(answers(crane_REQUEST_ESTOP)) << "the attack has no effect: this test proves nothing";
  std::vector<std::uint64_t> repetitions;
  const auto answered = [&] {
    client.receive();
    return std::ranges::any_of(
        repetitions, [&](auto id) { return client.take_reply(id, crane_SOURCE_SUPERVISOR).has_value(); });
  };
  do repetitions.push_back(client.repeat({.kind = crane_REQUEST_ESTOP}, repetitions.size() + 1));
  while (!stack_->until(answered, 100ms) && repetitions.size() < 20);
  std::cout << "answer after " << repetitions.size() << " repetitions\n";
  EXPECT_LT(repetitions.size(), 20U);
  EXPECT_TRUE(stack_->until([this] { return is(crane_STATE_ESTOP); }, 1s));
}

/// A HEARTBEAT hides the stop from the planner, which then continues its reference. The supervisor ends the
/// controlled stop after 8 s at the latest.
TEST_F(DiscoveryAttack, ThatHidesAStopFromThePlannerDelaysItByAtMostEightSeconds) {
  constexpr auto kMost = 8500ms;  // STOP_TIMEOUT, ramp and closing time of the brakes
  auto status = heard("trajectory_planner", topics::supervisor);
  const auto found = find(status.message, topics::supervisor).value();
  stack_->session().arm();
  stack_->session().request({.kind = crane_REQUEST_FOLLOW,
                             .selected = {true, false, false},
                             .target = {stack_->session().state()->trolley_position_m, 0, 0},
                             .sines = {{.amplitude = 0.05, .frequency_hz = 0.3, .phase_rad = 0}},
                             .duration_s = 60},
                            "follow");
  stack_->listen(3s);
  ASSERT_TRUE(is(crane_STATE_RUN));
  constexpr std::uint64_t kAhead = 1'000'000'000;
  send_to("trajectory_planner",
          heartbeat(prefix_of(status.message), entities_of(status.message, found.data).writer,
                    sequence_number_of(status.message, found.data) + kAhead));
  stack_->listen(100ms);
  stack_->session().request({.kind = crane_REQUEST_STOP}, "stop");
  const auto begin = std::chrono::steady_clock::now();
  const auto closed = [this] {
    const auto& state = stack_->observer().states().back();
    return state.brake_closed[0] && state.brake_closed[1] && state.applied_v[0] == 0;
  };
  EXPECT_TRUE(stack_->until(closed, kMost));
  std::cout << std::chrono::duration<double>(std::chrono::steady_clock::now() - begin) / 1s
            << " s from the stop to closed brakes; "
            << experiments::in_words(stack_->observer().statuses().back()) << '\n';
  const auto lost = [this] { return stack_->observer().nodes().at("trajectory_planner").lost_ticks; };
  EXPECT_TRUE(stack_->until([&] { return lost() > 100; }, 5s)) << "the attack has no effect";
}

TEST_F(DiscoveryAttack, WithForgedEndsOfSupervisorAndBridgeMovesNothing) {
  const auto supervisor = prefix_of(heard("plant", topics::command).message);
  const auto plant = prefix_of(heard("supervisor", topics::state).message);
  stack_->forget();
  FalseSupervisor stranger{stack_->bus_options()};
  const auto end = std::chrono::steady_clock::now() + 4s;
  auto next = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() < end) {
    if (std::chrono::steady_clock::now() >= next) {
      next += 100ms;
      send_to("plant", end_of_participant(supervisor));
      send_to("supervisor", end_of_participant(plant));
    }
    stranger.speak();
    stack_->listen(0ms);
  }
  expect_nothing_moved(states());
}

/// The attacker knows the identifiers of participants from their unencrypted headers, and those of writers
/// from a stack without keys.
TEST_F(DiscoveryAttack, WithKeysHasNoEffect) {
  std::set<EntityId> writers;
  for (const char* process : {"plant", "supervisor"}) {
    auto packet = process == std::string_view{"plant"} ? heard(process, topics::command)
                                                       : heard(process, topics::state);
    for (const auto& submessage : submessages(packet.message))
      if (submessage.kind == kData) writers.insert(entities_of(packet.message, submessage).writer);
  }
  const recording::TemporaryDirectory directory;
  security::make(directory / "keys", security::valid_for(1));
  auto options = default_options();
  options.bus.secure = (directory / "keys").string();
  start(options);
  std::set<GuidPrefix> participants;
  const auto end_of_search = std::chrono::steady_clock::now() + 1s;
  const auto own = ports("supervisor");
  Ear ear;
  while (std::chrono::steady_clock::now() < end_of_search)
    if (const auto packet = ear.next(10ms); packet && own.contains(packet->port()))
      participants.insert(prefix_of(packet->message));
  ASSERT_GE(participants.size(), 3U);  // bridge, friction compensation, operator
  stack_->session().arm();
  stack_->forget();
  std::uint64_t number = 1'000'000;
  const auto end = std::chrono::steady_clock::now() + 2s;
  while (std::chrono::steady_clock::now() < end) {
    for (const auto& prefix : participants)
      for (const char* process : kLoop) {
        send_to(process, end_of_participant(prefix));
        for (const auto& writer : writers) send_to(process, heartbeat(prefix, writer, ++number));
      }
    stack_->listen(10ms);
  }
  stack_->listen(300ms);
  std::cout << mouth_.sent() << " packets under the names of " << participants.size() << " participants and "
            << writers.size() << " writers\n";
  EXPECT_TRUE(is(crane_STATE_HOLD)) << experiments::in_words(stack_->observer().statuses().back());
  EXPECT_NO_THROW(stack_->session().request({.kind = crane_REQUEST_ESTOP}, "estop"));
}

/// How the attacker hides the states of the bridge from the supervisor.
enum class Blinding : std::uint8_t { skips_samples, ends_bridge };

class BlindSupervisor : public DiscoveryAttack, public testing::WithParamInterface<Blinding> {
 protected:
  /// Blinds the supervisor and forges its commands for `duration`.
  void attack_for(std::chrono::milliseconds duration) {
    auto state = heard("supervisor", topics::state);
    const auto found = find(state.message, topics::state).value();
    const auto writer = entities_of(state.message, found.data).writer;
    const auto prefix = prefix_of(state.message);
    auto number = sequence_number_of(state.message, found.data);
    FalseCommands impostor{heard("plant", topics::command)};
    bus::Bus bus{runtime::bus_options(stack_->bus_options(), "stranger", crane_SOURCE_MONITOR, 9)};
    auto states = bus.subscriber(topics::state);
    stack_->forget();
    const auto end = std::chrono::steady_clock::now() + duration;
    while (std::chrono::steady_clock::now() < end) {
      constexpr std::uint64_t kAhead = 1'000'000'000;
      send_to("supervisor", GetParam() == Blinding::ends_bridge
                                ? end_of_participant(prefix)
                                : heartbeat(prefix, writer, number += kAhead));
      bus.wait(2ms);
      while (const auto heard = states.take()) impostor.command(heard->header);
      stack_->listen(0ms);
    }
  }
};

TEST_P(BlindSupervisor, MovesNothing) {
  attack_for(4s);
  expect_nothing_moved(states());
}

/// Without keys and without the ledger no process can detect this attack: the supervisor sees no effect of
/// the forged commands. The limits of LastLine remain.
TEST_P(BlindSupervisor, WithoutTheLedgerLeavesTheLimitsOfTheBridgeInForce) {
  ASSERT_NO_FATAL_FAILURE(start(without_ledger()));
  attack_for(4s);
  const auto open = std::ranges::count_if(states(), [](const auto& state) { return !state.brake_closed[0]; });
  const auto rig = configuration::load_rig(stack::find_rig(kDiscoveryRig));
  const auto& trolley = rig.drives[0];
  for (const auto& state : states()) {
    ASSERT_GE(state.trolley_position_m, trolley.low_limit);
    ASSERT_LE(state.trolley_position_m, trolley.high_limit);
  }
  std::cout << "brakes open in " << open << " of " << states().size() << " states, trolley moved by "
            << farthest_m(states()) << " m, latch " << states().back().latch_reason << '\n';
  const auto& last = states().back();
  EXPECT_TRUE(last.brake_closed[0] && last.brake_closed[1] && last.applied_v[0] == 0);
  EXPECT_GT(open, 50) << "the attack has no effect: MovesNothing proves nothing";
}

INSTANTIATE_TEST_SUITE_P(By, BlindSupervisor, testing::Values(Blinding::skips_samples, Blinding::ends_bridge),
                         [](const auto& test) {
                           return test.param == Blinding::ends_bridge ? "TheEndOfTheBridge"
                                                                      : "SkippedSamples";
                         });

}  // namespace
}  // namespace crane::hostile
