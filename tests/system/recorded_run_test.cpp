/// Rows of a recording whose recorder took the topics in another order than they were written.
#include "recorded_run.hpp"

#include <gtest/gtest.h>

#include "../recording/temporary_directory.hpp"
#include "crane/bus/cdr.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/recording/mcap_writer.hpp"
#include "stack/data_files.hpp"

namespace crane::system_test {
namespace {

constexpr std::int64_t kTick_ns = 10'000'000;
constexpr std::uint64_t kFirst = 100, kReady = 250, kLast = 300;

class RecordedRun : public testing::Test {
 protected:
  template <class T>
  void write(const topics::Topic<T>& topic, std::uint16_t channel, const T& sample, std::int64_t log_ns,
             std::int64_t written_ns) {
    const auto& codec = bus::CdrCodec::of(*topic.description.descriptor);
    std::vector<std::uint8_t> cdr{0, 1, 0, 0};
    cdr.resize(4 + codec.max_encoded_bytes());
    cdr.resize(4 + codec.encode(&sample, std::span{cdr}.subspan(4)));
    writer_.message(channel, 0, log_ns, written_ns, cdr);
  }
  void write_state(std::uint64_t tick) {
    msg::State state{};
    state.header = {.tick = tick, .sample_time_ns = time_of(tick), .source = crane_SOURCE_PLANT, .epoch = 1};
    for (bool& closed : state.brake_closed) closed = true;
    write(topics::state, state_, state, time_of(tick), time_of(tick));
  }
  void write_status(std::uint64_t tick, std::uint32_t epoch, crane_SupervisorState in_state,
                    std::int64_t late_ns = 0) {
    msg::SupervisorStatus status{};
    status.header = {
        .tick = tick, .sample_time_ns = time_of(tick), .source = crane_SOURCE_SUPERVISOR, .epoch = epoch};
    status.state = in_state;
    const auto written_ns = time_of(tick) + kStep_ns;
    write(topics::supervisor, status_, status, written_ns + late_ns, written_ns);
  }
  static std::int64_t time_of(std::uint64_t tick) { return static_cast<std::int64_t>(tick) * kTick_ns; }

  static constexpr std::int64_t kStep_ns = 1'000'000;  ///< from a state to the status of its tick

  std::uint16_t add(const topics::Description& topic) { return writer_.channel(0, topic.name, "cdr"); }

  recording::TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_ / "run.mcap";
  recording::McapWriter writer_{file_};
  std::uint16_t state_ = add(topics::state.description), status_ = add(topics::supervisor.description),
                request_ = add(topics::request.description);
};

class RecordedRequest : public RecordedRun {
 protected:
  /// The crane is LOCKED, and READY from kReady on. @return violations of reset_and_arm
  std::size_t violations_with_a_reset(std::int64_t log_ns, std::int64_t written_ns) {
    for (auto tick = kFirst; tick <= kLast; ++tick) {
      write_state(tick);
      write_status(tick, 2, tick < kReady ? crane_STATE_LOCKED : crane_STATE_READY);
    }
    msg::Request request{};
    request.kind = crane_REQUEST_RESET;
    write(topics::request, request_, request, log_ns, written_ns);
    writer_.close();
    campaign::Run run{.begin_ns = 0, .onset_ns = kLast * kTick_ns, .expectation = {}};
    run.rows = Recorded{file_}.rows(0, kLast * kTick_ns, true);
    EXPECT_EQ(run.rows.size(), kLast - kFirst + 1);
    const auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower").string());
    const auto verdict = campaign::judge(rig, run);
    return static_cast<std::size_t>(std::ranges::count(verdict.violations, campaign::Invariant::reset_and_arm,
                                                       &campaign::Violation::invariant));
  }
  static constexpr std::int64_t kReady_ns = kReady * kTick_ns + kStep_ns;
};

TEST_F(RecordedRequest, CountsFromItsSourceTimeWhenItIsRecordedLate) {
  EXPECT_EQ(violations_with_a_reset(kReady_ns + 5 * kTick_ns, kReady_ns - kStep_ns / 2), 0U);
}

TEST_F(RecordedRequest, WrittenLongBeforeItsReportedEffectIsReported) {
  EXPECT_EQ(violations_with_a_reset(kReady_ns - 101 * kTick_ns, kReady_ns - 101 * kTick_ns), 1U);
}

TEST_F(RecordedRequest, WrittenAfterItsReportedEffectIsReported) {
  EXPECT_EQ(violations_with_a_reset(kReady_ns + 1, kReady_ns + 1), 1U);
}

TEST_F(RecordedRun, FollowsARestartedProcessThatTheRecorderDiscoversLate) {
  constexpr std::uint64_t kRestart = 150, kBegin = 160, kForged = 290;
  for (auto tick = kFirst; tick <= kLast; ++tick) {
    write_state(tick);
    if (tick < kRestart)
      write_status(tick, 2, crane_STATE_RUN);
    else
      write_status(tick, 3, crane_STATE_LOCKED, 20 * kTick_ns);
    if (tick >= kForged) write_status(tick, 4, crane_STATE_HOLD);
  }
  writer_.close();
  const auto rows = Recorded{file_}.rows(time_of(kBegin), time_of(kLast - 30), false);
  ASSERT_EQ(rows.size(), kLast - 30 - kBegin + 1);
  for (const auto& row : rows) EXPECT_EQ(row.status.state, crane_STATE_LOCKED) << row.state.header.tick;
}

}  // namespace
}  // namespace crane::system_test
