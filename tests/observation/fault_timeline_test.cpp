#include "observation/fault_timeline.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "samples.hpp"

namespace crane::observation {
namespace {

SamplePtr event_at(std::int64_t at_ns, crane_Severity severity, const char* code) {
  msg::Event event{};
  event.severity = severity;
  runtime::assign(event.node, "plant");
  runtime::assign(event.code, code);
  runtime::assign(event.what, "what happened");
  return sample_of(topics::event, event, at_ns);
}

SamplePtr latched_at(std::int64_t at_ns, crane_LatchReason reason) {
  msg::State state{};
  state.latch_reason = reason;
  state.header.source = crane_SOURCE_PLANT;
  return sample_of(topics::state, state, at_ns);
}

SamplePtr beat_at(std::int64_t at_ns, crane_NodePhase phase = crane_PHASE_READY) {
  msg::NodeStatus status{};
  status.node = crane_SOURCE_TRACKING;
  status.phase = phase;
  runtime::assign(status.name, "tracking");
  return sample_of(topics::node, status, at_ns);
}

TEST(FaultTimeline, ALatchIsTheFirstCauseAndTheStopOfTheSupervisorItsConsequence) {
  FaultTimeline timeline;
  timeline.add(*status_at(9 * kSecond_ns, crane_STATE_RUN, crane_CAUSE_NONE));
  // The event is written first and arrives last.
  timeline.add(*status_at(10 * kSecond_ns + 2, crane_STATE_STOP_C0, crane_CAUSE_BRIDGE_LATCHED));
  timeline.add(*latched_at(10 * kSecond_ns, crane_LATCH_SPEED));
  timeline.add(*event_at(10 * kSecond_ns + 1, crane_SEVERITY_ERROR, "latched"));
  ASSERT_EQ(timeline.faults().size(), 1U);
  const auto& notes = timeline.faults()[0].notes;
  ASSERT_EQ(notes.size(), 3U);
  EXPECT_EQ(notes[0].what, "LATCH_speed");
  EXPECT_EQ(notes[1].what, "latched");
  EXPECT_EQ(notes[2].what, "BRIDGE_LATCHED");
  EXPECT_FALSE(notes[0].remedy.empty());
}

TEST(FaultTimeline, AnEventThatAnnouncesACauseOrALatchIsMergedWithIt) {
  FaultTimeline timeline;
  timeline.add(*event_at(10 * kSecond_ns, crane_SEVERITY_ERROR, "speed"));
  timeline.add(*latched_at(10 * kSecond_ns + 3, crane_LATCH_SPEED));
  timeline.add(*status_at(10 * kSecond_ns + 4, crane_STATE_STOP_C0, crane_CAUSE_BRIDGE_LATCHED));
  timeline.add(*event_at(10 * kSecond_ns + 5, crane_SEVERITY_ERROR, "another"));
  ASSERT_EQ(timeline.faults().size(), 1U);
  const auto& notes = timeline.faults()[0].notes;
  ASSERT_EQ(notes.size(), 3U);
  EXPECT_EQ(notes[0].what, "LATCH_speed");
  EXPECT_EQ(notes[0].at_ns, 10 * kSecond_ns);
  EXPECT_EQ(notes[2].what, "another");
}

TEST(FaultTimeline, AProcessThatBecameSilentPrecedesTheStopThatItCaused) {
  FaultTimeline timeline;
  Traffic traffic;
  const History history;
  traffic.add(*beat_at(10 * kSecond_ns));
  timeline.add(*status_at(10 * kSecond_ns + 400'000'000, crane_STATE_STOP_C1, crane_CAUSE_DEMAND_STALE));
  timeline.poll(12 * kSecond_ns, 12 * kSecond_ns, traffic, history);
  ASSERT_EQ(timeline.faults()[0].notes.size(), 1U);
  EXPECT_TRUE(timeline.poll(13 * kSecond_ns, 13 * kSecond_ns, traffic, history));
  const auto& notes = timeline.faults()[0].notes;
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_EQ(notes[0].what, "process_silent");
  EXPECT_EQ(notes[0].from, "tracking");
  EXPECT_EQ(notes[1].what, "DEMAND_STALE");
}

TEST(FaultTimeline, DistantNotesAreDifferentFaults) {
  FaultTimeline timeline;
  timeline.add(*status_at(10 * kSecond_ns, crane_STATE_ESTOP, crane_CAUSE_OPERATOR_ESTOP));
  timeline.add(*status_at(20 * kSecond_ns, crane_STATE_HOLD, crane_CAUSE_NONE));
  timeline.add(*status_at(30 * kSecond_ns, crane_STATE_STOP_C1, crane_CAUSE_SWING_LIMIT));
  ASSERT_EQ(timeline.faults().size(), 2U);
  EXPECT_EQ(timeline.faults()[0].notes[0].kind, Note::Kind::order);
  EXPECT_EQ(timeline.faults()[0].cleared_ns, 20 * kSecond_ns);
  EXPECT_EQ(timeline.faults()[1].notes[0].kind, Note::Kind::fault);
  EXPECT_EQ(timeline.faults()[1].cleared_ns, 0);
}

TEST(FaultTimeline, StartAndInformationAreNotFaults) {
  FaultTimeline timeline;
  timeline.add(*status_at(kSecond_ns, crane_STATE_LOCKED, crane_CAUSE_START));
  timeline.add(*event_at(kSecond_ns, crane_SEVERITY_INFO, "ready"));
  timeline.add(*latched_at(kSecond_ns, crane_LATCH_NONE));
  EXPECT_TRUE(timeline.faults().empty());
}

TEST(FaultTimeline, AFloodOfEventsIsBoundedAndCounted) {
  FaultTimeline timeline;
  for (int i = 0; i < 10'000; ++i)
    timeline.add(*event_at(kSecond_ns + i, crane_SEVERITY_WARNING, ("code_" + std::to_string(i)).c_str()));
  ASSERT_EQ(timeline.faults().size(), 1U);
  EXPECT_EQ(timeline.faults()[0].notes.size(), FaultTimeline::kMostNotes);
  EXPECT_EQ(timeline.faults()[0].left_out, 10'000 - FaultTimeline::kMostNotes);
  for (int i = 0; i < 1000; ++i)
    timeline.add(*event_at((10 + 10 * i) * kSecond_ns, crane_SEVERITY_WARNING, "again"));
  EXPECT_EQ(timeline.faults().size(), FaultTimeline::kMostFaults);
}

TEST(FaultTimeline, KeepsTheDataFromTenSecondsBeforeToFiveAfter) {
  FaultTimeline timeline;
  History history;
  const Traffic traffic;
  for (int second = 0; second <= 40; ++second)
    history.add(sample_of(topics::state, msg::State{}, second * kSecond_ns));
  timeline.add(*status_at(20 * kSecond_ns, crane_STATE_ESTOP, crane_CAUSE_ESTOP_INPUT));
  timeline.poll(24 * kSecond_ns, 24 * kSecond_ns, traffic, history);
  EXPECT_TRUE(timeline.faults()[0].surrounding_samples.empty());
  timeline.poll(25 * kSecond_ns, 25 * kSecond_ns, traffic, history);
  const auto& samples = timeline.find(1)->surrounding_samples.at(0);
  ASSERT_EQ(samples.size(), 16U);
  EXPECT_EQ(samples.front()->log_time_ns, 10 * kSecond_ns);
  EXPECT_EQ(samples.back()->log_time_ns, 25 * kSecond_ns);
}

}  // namespace
}  // namespace crane::observation
