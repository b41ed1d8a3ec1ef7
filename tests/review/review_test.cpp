#include "review/review.hpp"

#include <gmock/gmock.h>

#include "../observation/samples.hpp"
#include "../recording/temporary_directory.hpp"

namespace crane::review {
namespace {

using observation::kSecond_ns;
using observation::SamplePtr;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::int64_t kZero_ns = 1'795'579'498 * kSecond_ns;  // 2026-11-25 04:04:58 UTC

SamplePtr state_at(std::int64_t at_ns, std::uint64_t tick, crane_LatchReason latch = crane_LATCH_NONE) {
  msg::State state{};
  state.header.source = crane_SOURCE_PLANT;
  state.latch_reason = latch;
  state.swing_radial_rad = 0.1;
  return observation::sample_of(topics::state, state, at_ns, tick);
}

class Recorded : public testing::Test {
 protected:
  void write(const std::vector<SamplePtr>& samples) {
    recording::McapWriter writer{file};
    const auto channels = recording::add_topic_channels(writer);
    for (const auto& sample : samples)
      writer.message(channels[sample->topic], static_cast<std::uint32_t>(sample->header.tick),
                     sample->log_time_ns, sample->source_time_ns, sample->cdr);
    writer.close();
  }
  /// A second of a run, then a latch of the bridge, then the stop of the supervisor.
  void write_a_latch() {
    std::vector<SamplePtr> samples;
    for (std::uint64_t tick = 1; tick <= 100; ++tick) {
      const auto at_ns = kZero_ns + static_cast<std::int64_t>(tick) * kSecond_ns / 100;
      samples.push_back(state_at(at_ns, tick, tick < 90 ? crane_LATCH_NONE : crane_LATCH_SPEED));
      samples.push_back(observation::status_at(at_ns + 1, tick < 91 ? crane_STATE_RUN : crane_STATE_STOP_C0,
                                               tick < 91 ? crane_CAUSE_NONE : crane_CAUSE_BRIDGE_LATCHED,
                                               tick));
    }
    write(samples);
  }
  recording::TemporaryDirectory directory;
  std::filesystem::path file = directory / "run.mcap";
};

TEST_F(Recorded, TheFirstSentenceNamesTheFirstCauseAndTheThirdItsConsequence) {
  write_a_latch();
  const auto lines = sentences(review(file));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_THAT(lines[0],
              StartsWith("The first cause is LATCH_speed at 0.89 s (04:04:58 UTC), tick 90, from plant, "
                         "in state RUN"));
  EXPECT_THAT(lines[1], StartsWith("What to do: "));
  EXPECT_THAT(lines[2], StartsWith("Then: BRIDGE_LATCHED"));
}

/// A recording begins after a stop, and contains a disarm before the stop that it explains.
TEST_F(Recorded, AStopBeforeTheRecordingAndAnOrderlyEndAreNotTheFirstCause) {
  std::vector<SamplePtr> samples;
  const auto add = [&](double time_s, crane_SupervisorState state, crane_Cause cause) {
    samples.push_back(observation::status_at(kZero_ns + static_cast<std::int64_t>(time_s * 1e9), state, cause,
                                             samples.size() + 1));
  };
  add(0, crane_STATE_LOCKED, crane_CAUSE_OPERATOR_ESTOP);
  add(4, crane_STATE_HOLD, crane_CAUSE_NONE);
  add(8, crane_STATE_STOP_C1, crane_CAUSE_OPERATOR_DISARM);
  add(12, crane_STATE_HOLD, crane_CAUSE_NONE);
  write(samples);
  EXPECT_THAT(sentences(review(file)).front(), HasSubstr("OPERATOR_DISARM"));
  add(16, crane_STATE_STOP_C1, crane_CAUSE_OPERATOR_STOP);
  write(samples);
  EXPECT_THAT(sentences(review(file)).front(), HasSubstr("The first cause is OPERATOR_STOP at 16.00 s"));
}

TEST_F(Recorded, AStopBeforeTheRecordingIsNamedWhenNoneFollows) {
  write({observation::status_at(kZero_ns, crane_STATE_LOCKED, crane_CAUSE_IDLE, 1)});
  const auto lines = sentences(review(file));
  EXPECT_THAT(lines.front(), HasSubstr("IDLE"));
  EXPECT_THAT(lines.front(), HasSubstr("the supervisor was in LOCKED"));
}

TEST_F(Recorded, ThePageIsSelfContainedAndHasStatesFiguresAndCurves) {
  write_a_latch();
  const auto html = report::to_html(page_of(review(file)));
  for (const auto* text :
       {"The first cause is LATCH_speed", "STOP_C0", "radial 5.73 deg", "crane/state", "uPlot"})
    EXPECT_THAT(html, HasSubstr(text));
  EXPECT_THAT(html, testing::Not(HasSubstr("src=\"http")));
  EXPECT_EQ(html, report::to_html(page_of(review(file))));
}

TEST_F(Recorded, WithoutAStopNoCauseIsNamed) {
  write({state_at(kZero_ns, 1), observation::status_at(kZero_ns + 1, crane_STATE_HOLD, crane_CAUSE_NONE)});
  EXPECT_EQ(sentences(review(file)).front(), "Nothing stopped the crane in this recording.");
}

TEST_F(Recorded, TheIntactPartsOfADamagedFileAreReviewed) {
  write_a_latch();
  const auto bytes = recording::contents_of(file);
  recording::put_contents(file, bytes.substr(0, bytes.size() - 40));  // index and end of the file are missing
  const auto found = review(file);
  EXPECT_FALSE(found.problems.empty());
  EXPECT_THAT(sentences(found).front(), HasSubstr("LATCH_speed"));
  EXPECT_THAT(sentences(found).back(), StartsWith("The file is damaged: "));
}

TEST_F(Recorded, AFileThatIsNotARecordingIsRefused) {
  recording::put_contents(file, "trolley,slew\n1,2\n");
  EXPECT_THROW((void)review(file), recording::ReadError);
}

}  // namespace
}  // namespace crane::review
