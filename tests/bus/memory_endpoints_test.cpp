/// Readers and writers in memory: cranes, matching, handlers, lifetimes, shared participants.
#include "memory_bus.hpp"

namespace crane::bus {
namespace {

using namespace std::chrono_literals;

TEST_F(Memory, TwoCranesDoNotSeeEachOtherAndAStarSeesBoth) {
  Bus north = bus("north");
  Bus south = bus("south");
  Bus all = bus("*");
  auto north_reader = north.subscriber(topics::state);
  auto south_reader = south.subscriber(topics::state);
  auto all_reader = all.subscriber(topics::state);
  auto north_writer = north.publisher(topics::state);
  auto south_writer = south.publisher(topics::state);
  auto sample = state(1);
  EXPECT_TRUE(north_writer.publish(sample));
  sample = state(2);
  EXPECT_TRUE(south_writer.publish(sample));
  EXPECT_EQ(ticks(north_reader), Ticks{1});
  EXPECT_EQ(ticks(south_reader), Ticks{2});
  EXPECT_EQ(ticks(all_reader), (Ticks{1, 2}));
}

/// A request in the partition "*" would move every crane.
TEST_F(Memory, ANameOfSeveralCranesIsForReadersOnly) {
  for (const char* name : {"*", "north*", "c?ane", "[ab]"}) {
    Bus several = bus(name);
    EXPECT_NO_THROW((void)several.subscriber(topics::state)) << name;
    EXPECT_THROW((void)several.publisher(topics::request), Error) << name;
    EXPECT_THROW((void)several.cdr_publisher(topics::request.description), Error) << name;
    EXPECT_THROW((void)several.share(crane_SOURCE_OPERATOR, 1).publisher(topics::request), Error) << name;
  }
}

TEST_F(Memory, ReportsMatchedAndUnmatchedEndpointsWithTheirNumber) {
  Bus a = bus();
  std::vector<std::string> events;
  const auto note = [&events](const Event& event) {
    events.push_back(std::string{to_string(event.kind)} + " " + std::to_string(event.current));
  };
  auto writer = a.publisher(topics::state, {.on_event = note});
  EXPECT_EQ(writer.matched(), 0);
  {
    auto reader = a.subscriber(topics::state);
    EXPECT_EQ(writer.matched(), 1);
    EXPECT_EQ(reader.matched(), 1);
    auto other_topic = a.subscriber(topics::command);
    EXPECT_EQ(other_topic.matched(), 0);
  }
  EXPECT_EQ(writer.matched(), 0);
  EXPECT_EQ(events, (std::vector<std::string>{"matched 1", "unmatched 0"}));
}

TEST_F(Memory, AHandlerMayCallTheBus) {
  Bus a = bus();
  auto writer = a.publisher(topics::state);
  int seen = -1;
  auto reader = a.subscriber(topics::state, {.on_event = [&](const Event&) { seen = writer.matched(); }});
  EXPECT_EQ(seen, 1);
}

TEST_F(Memory, EndpointsSurviveTheirBus) {
  auto a = std::make_unique<Bus>(bus());
  auto writer = a->publisher(topics::state);
  auto reader = a->subscriber(topics::state);
  a.reset();
  network_.reset();
  auto sample = state(9);
  EXPECT_TRUE(writer.publish(sample));
  EXPECT_EQ(ticks(reader), Ticks{9});
}

/// A share is a bus of its own on the same participant.
TEST_F(Memory, ASharedParticipantDeliversToItsOtherBusWithTheSourceOfEach) {
  auto first = bus();
  auto second = first.share(crane_SOURCE_SUPERVISOR, 4);
  auto statuses_in = first.subscriber(topics::supervisor);
  auto states_in = second.subscriber(topics::state);
  auto states_out = first.publisher(topics::state);
  auto statuses_out = second.publisher(topics::supervisor);

  EXPECT_TRUE(states_out.publish(state(1)));
  EXPECT_TRUE(second.wait(0ns));
  EXPECT_FALSE(first.wait(0ns)) << "the sample is for the other bus";
  EXPECT_TRUE(statuses_out.publish({}));
  SampleInfo of_state, of_status;
  const auto seen_state = states_in.take(&of_state);
  const auto seen_status = statuses_in.take(&of_status);
  ASSERT_TRUE(seen_state && seen_status);
  EXPECT_EQ(seen_state->header.source, crane_SOURCE_PLANT);
  EXPECT_EQ(seen_state->header.epoch, 3U);
  EXPECT_EQ(seen_status->header.source, crane_SOURCE_SUPERVISOR);
  EXPECT_EQ(seen_status->header.epoch, 4U);
  EXPECT_EQ(of_state.participant, of_status.participant);
  EXPECT_NE(of_state.writer, of_status.writer);
}

}  // namespace
}  // namespace crane::bus
