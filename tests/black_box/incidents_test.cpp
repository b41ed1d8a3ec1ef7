#include "black_box/incidents.hpp"

#include <gtest/gtest.h>

#include "../observation/samples.hpp"

namespace crane::black_box {
namespace {

using observation::kSecond_ns;
using observation::status_at;

/// A supervisor at 10 Hz; the test sets its state.
class Crane {
 public:
  explicit Crane(std::int64_t started_ns = 0) : incidents{started_ns}, now_ns_{started_ns} {}

  void run(double seconds, crane_SupervisorState state, crane_Cause cause) {
    for (int i = 0; i < static_cast<int>(seconds * 10); ++i) {
      now_ns_ += kSecond_ns / 10;
      incidents.add(status_at(now_ns_, state, cause));
      if (auto incident = incidents.poll(now_ns_, now_ns_)) kept.push_back(*std::move(incident));
      most_bytes = std::max(most_bytes, incidents.bytes());
    }
  }
  void work(double seconds) { run(seconds, crane_STATE_HOLD, crane_CAUSE_NONE); }
  void trip(double seconds, crane_Cause cause = crane_CAUSE_SWING_LIMIT) {
    run(seconds, crane_STATE_STOP_C0, cause);
  }

  Incidents incidents;
  std::vector<Incident> kept;
  std::size_t most_bytes = 0;

 private:
  std::int64_t now_ns_;
};

TEST(Incidents, ATripIsKeptFrom10SecondsBeforeTo5After) {
  Crane crane;
  crane.work(30);
  crane.trip(10);
  ASSERT_EQ(crane.kept.size(), 1U);
  const auto& incident = crane.kept[0];
  EXPECT_EQ(incident.first.what, "SWING_LIMIT");
  const auto trip_ns = 30 * kSecond_ns + kSecond_ns / 10;
  EXPECT_EQ(incident.samples.front()->log_time_ns, trip_ns - 10 * kSecond_ns);
  EXPECT_EQ(incident.samples.back()->log_time_ns, trip_ns + 5 * kSecond_ns);
  EXPECT_EQ(incident.samples.size(), 151U);
}

TEST(Incidents, OverlappingTripsAreOneIncident) {
  Crane crane;
  crane.work(30);
  crane.trip(3.5);
  crane.work(1);
  crane.trip(10, crane_CAUSE_OVERSPEED);
  ASSERT_EQ(crane.kept.size(), 1U);
  EXPECT_EQ(crane.kept[0].faults, 2U);
  EXPECT_EQ(crane.kept[0].first.what, "SWING_LIMIT");
  EXPECT_EQ(crane.kept[0].samples.size(), 151U + 45U);
}

TEST(Incidents, TripsThatAreFarApartAreTwo) {
  Crane crane;
  crane.work(30);
  crane.trip(10);
  crane.work(20);
  crane.trip(10, crane_CAUSE_OVERSPEED);
  ASSERT_EQ(crane.kept.size(), 2U);
  EXPECT_EQ(crane.kept[1].first.what, "OVERSPEED");
}

TEST(Incidents, APlannedEndIsNotAnIncident) {
  Crane crane;
  crane.work(5);
  for (const auto cause : {crane_CAUSE_OPERATOR_DISARM, crane_CAUSE_IDLE, crane_CAUSE_HOMED}) {
    crane.trip(10, cause);
    crane.work(5);
  }
  EXPECT_TRUE(crane.kept.empty());
  crane.trip(10, crane_CAUSE_OPERATOR_STOP);
  EXPECT_EQ(crane.kept.size(), 1U);
}

TEST(Incidents, AContinuouslyTrippingCraneCausesAFilePerMinuteAndBoundedMemory) {
  Crane crane;
  for (int i = 0; i < 600; ++i) {
    crane.trip(1, i % 2 == 0 ? crane_CAUSE_SWING_LIMIT : crane_CAUSE_OVERSPEED);
    crane.work(1);
  }
  EXPECT_GE(crane.kept.size(), 18U);
  EXPECT_LE(crane.kept.size(), 25U);
  for (const auto& incident : crane.kept)
    EXPECT_LE(incident.until_ns - incident.from_ns, Incidents::kLongest_ns);
  Crane quiet;
  quiet.work(static_cast<double>(Incidents::kKept_ns / kSecond_ns) + 1);
  EXPECT_LE(crane.most_bytes, quiet.most_bytes + 1000);
}

TEST(Incidents, PendingIncidentsAreReturnedAtTheEndOfTheStack) {
  Crane crane;
  crane.work(20);
  crane.trip(1);
  EXPECT_TRUE(crane.kept.empty());
  EXPECT_TRUE(crane.incidents.poll(21 * kSecond_ns, 21 * kSecond_ns, true).has_value());

  Crane ended;
  ended.work(20);
  ended.incidents.ignore_causes_after(20 * kSecond_ns);
  ended.trip(1, crane_CAUSE_STATE_STALE);
  EXPECT_FALSE(ended.incidents.poll(21 * kSecond_ns, 21 * kSecond_ns, true).has_value());
}

TEST(Incidents, SamplesFromBeforeTheStartAreNotKept) {
  Crane crane{100 * kSecond_ns};
  msg::Event event{};
  event.severity = crane_SEVERITY_ERROR;
  runtime::assign(event.code, "latched");
  auto old =
      std::make_shared<observation::Sample>(*observation::sample_of(topics::event, event, 101 * kSecond_ns));
  // an old sample that its writer has stored for readers that join later
  old->source_time_ns = 50 * kSecond_ns;
  crane.incidents.add(old);
  crane.work(20);
  EXPECT_TRUE(crane.kept.empty());
}

}  // namespace
}  // namespace crane::black_box
