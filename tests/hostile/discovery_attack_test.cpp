/// Forged RTPS packets that occupy memory or time. Permitted: the crane stops. Forbidden: motion, a process
/// that hangs, memory without bound.
#include <random>

#include "discovery_attack.hpp"

namespace crane::hostile {
namespace {

constexpr std::uint64_t kSeed = 27'112'026;

/// 350 participants per second, the rate that leaves the loop undisturbed: docs/security.md states the memory
/// for each. tests/hostile/flood_attack_test.cpp tests the limit of the memory.
TEST_F(DiscoveryAttack, ByParticipantsThatDoNotExistNeitherMovesNorHangsAnArmedCrane) {
  stack_->session().arm();
  stack_->forget();
  const auto before_kb = memory_kb();
  std::mt19937_64 random{kSeed};
  int sent = 0;
  const auto end = std::chrono::steady_clock::now() + 3s;
  while (std::chrono::steady_clock::now() < end) {
    for (int i = 0; i < 20; ++i, ++sent) {
      GuidPrefix prefix;
      for (auto& byte : prefix) byte = static_cast<std::uint8_t>(random());
      for (const char* process : kLoop) send_to(process, participant(prefix, kDomain));
    }
    stack_->listen(5ms);
  }
  stack_->listen(500ms);
  std::cout << sent << " participants, seed " << kSeed << '\n';
  expect_hold_or_stop();
  constexpr long kMostPerParticipant_kb = 20;
  expect_growth_below(kMostPerParticipant_kb * sent, before_kb);
}

/// Forged ends of all processes, sent to all processes: each one loses its writers and readers.
TEST_F(DiscoveryAttack, ByTheEndOfEveryProcessStopsAnArmedCrane) {
  std::map<std::string, GuidPrefix> prefixes;
  const auto learn = [&](const char* writer, const char* reader, const auto& topic) {
    prefixes[writer] = prefix_of(heard(reader, topic).message);
  };
  learn("plant", "supervisor", topics::state);
  learn("trajectory_planner", "supervisor", topics::reference);
  learn("tracking", "friction_compensation", topics::tracking);
  learn("anti_swing", "friction_compensation", topics::anti_swing);
  learn("friction_compensation", "supervisor", topics::demand);
  learn("supervisor", "plant", topics::command);
  ASSERT_EQ(prefixes.size(), std::size(kLoop));
  stack_->session().arm();
  stack_->forget();
  const auto end = std::chrono::steady_clock::now() + 1s;
  while (std::chrono::steady_clock::now() < end) {
    for (const char* process : kLoop)
      for (const auto& [name, prefix] : prefixes)
        if (name != process) send_to(process, end_of_participant(prefix));
    stack_->listen(20ms);
  }
  stack_->listen(500ms);
  expect_hold_or_stop();
  EXPECT_FALSE(is(crane_STATE_HOLD)) << "the packets have no effect: this test proves nothing";
}

/// The first fragment of samples of 2 GB, under the identifier of the bridge's writer.
TEST_F(DiscoveryAttack, ByFragmentsOfHugeSamplesFillsNoMemory) {
  auto state = heard("supervisor", topics::state);
  const auto found = find(state.message, topics::state).value();
  stack_->session().arm();
  stack_->forget();
  const auto before_kb = memory_kb();
  auto number = sequence_number_of(state.message, found.data) + 100'000;
  const auto end = std::chrono::steady_clock::now() + 2s;
  int sent = 0;
  while (std::chrono::steady_clock::now() < end) {
    for (int i = 0; i < 50; ++i, ++sent)
      send_to("supervisor",
              fragment(prefix_of(state.message), entities_of(state.message, found.data).writer, ++number));
    stack_->listen(5ms);
  }
  stack_->listen(300ms);
  std::cout << sent << " fragments\n";
  expect_hold_or_stop();
  constexpr long kGrowth_kb = 16 * 1024;
  expect_growth_below(kGrowth_kb, before_kb);
}

/// Negative acknowledgements of all samples, under the identifier of each reader that the bridge has heard
/// of.
TEST_F(DiscoveryAttack, ByRequestsToRepeatEverySampleNeitherMovesNorHangsAnArmedCrane) {
  stack_->session().arm();
  stack_->forget();
  std::uint32_t count = 0x40000000;
  int sent = 0;
  Ear ear;
  const auto end = std::chrono::steady_clock::now() + 2s;
  std::set<Bytes> readers;
  const auto own = ports("plant");
  while (std::chrono::steady_clock::now() < end) {
    for (int i = 0; i < 200; ++i)
      if (const auto packet = ear.next(0ms); packet && own.contains(packet->port()))
        for (const auto& s : submessages(packet->message))
          if (s.kind == kAckNack) {
            Bytes reader(packet->message.begin(), packet->message.begin() + kHeaderBytes);
            reader.insert(reader.end(), packet->message.begin() + static_cast<std::ptrdiff_t>(s.content),
                          packet->message.begin() + static_cast<std::ptrdiff_t>(s.content) + 8);
            readers.insert(reader);
          }
    const auto number = stack_->session().state()->header.tick;  // about the number of the newest sample
    for (int i = 0; i < 10; ++i)
      for (const auto& reader : readers) {
        Bytes message(reader.begin(), reader.begin() + kHeaderBytes);
        append(message, kAckNack, 0,
               repeat_all({reader.begin() + kHeaderBytes, reader.end()}, number > 200 ? number - 200 : 1,
                          ++count));
        send_to("plant", message);
        ++sent;
      }
    stack_->listen(2ms);
  }
  stack_->listen(300ms);
  std::cout << sent << " requests under the identifiers of " << readers.size() << " readers\n";
  expect_hold_or_stop();
}

}  // namespace
}  // namespace crane::hostile
