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

class RecordedRequest : public testing::Test {
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
  /// The crane is LOCKED, and READY from kReady on. @return violations of reset_and_arm
  std::size_t violations_with_a_reset(std::int64_t log_ns, std::int64_t written_ns) {
    for (auto tick = kFirst; tick <= kLast; ++tick) {
      const auto time_ns = static_cast<std::int64_t>(tick) * kTick_ns;
      msg::State state{};
      state.header = {.tick = tick, .sample_time_ns = time_ns, .source = crane_SOURCE_PLANT, .epoch = 1};
      for (bool& closed : state.brake_closed) closed = true;
      write(topics::state, state_, state, time_ns, time_ns);
      msg::SupervisorStatus status{};
      status.header = {
          .tick = tick, .sample_time_ns = time_ns, .source = crane_SOURCE_SUPERVISOR, .epoch = 2};
      status.state = tick < kReady ? crane_STATE_LOCKED : crane_STATE_READY;
      write(topics::supervisor, status_, status, time_ns + kStep_ns, time_ns + kStep_ns);
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
  static constexpr std::int64_t kStep_ns = 1'000'000;  ///< from a state to the status of its tick
  static constexpr std::int64_t kReady_ns = kReady * kTick_ns + kStep_ns;

  std::uint16_t add(const topics::Description& topic) { return writer_.channel(0, topic.name, "cdr"); }

  recording::TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_ / "run.mcap";
  recording::McapWriter writer_{file_};
  std::uint16_t state_ = add(topics::state.description), status_ = add(topics::supervisor.description),
                request_ = add(topics::request.description);
};

TEST_F(RecordedRequest, CountsFromItsWritingOnWhenTheRecorderTakesItLate) {
  EXPECT_EQ(violations_with_a_reset(kReady_ns + 5 * kTick_ns, kReady_ns - kStep_ns / 2), 0U);
}

TEST_F(RecordedRequest, ThatWasWrittenLongBeforeItsAllegedEffectIsAViolation) {
  EXPECT_EQ(violations_with_a_reset(kReady_ns - 101 * kTick_ns, kReady_ns - 101 * kTick_ns), 1U);
}

TEST_F(RecordedRequest, ThatWasWrittenAfterItsAllegedEffectIsAViolation) {
  EXPECT_EQ(violations_with_a_reset(kReady_ns + 1, kReady_ns + 1), 1U);
}

}  // namespace
}  // namespace crane::system_test
