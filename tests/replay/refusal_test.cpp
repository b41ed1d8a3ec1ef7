// Recordings that cannot be replayed are refused with the reason.
#include <gtest/gtest.h>

#include "recorded_crane.hpp"
#include "recorder/recorder.hpp"
#include "replay/replay.hpp"

namespace crane::replay_test {
namespace {

class RefusedRecording : public testing::Test {
 protected:
  void SetUp() override {
    RecordedCrane crane{file_, "virginia_tech_tower", "gain_scheduling_partial"};
    crane.run(0.5);
    crane.finish();
  }
  static std::string reason_of(const std::filesystem::path& file) {
    try {
      (void)replay::replay(file, replay::loop_components());
    } catch (const replay::Refusal& refusal) {
      return refusal.what();
    }
    return "replayed";
  }
  /// @param origin  metadata of the copy
  std::string reason_with(const recording::Metadata& origin, const Change& change = keep) {
    const auto copy = directory_ / "copy.mcap";
    copy_changed(file_, copy, change, &origin);
    return reason_of(copy);
  }
  static bool keep(const recording::Message&, std::vector<std::uint8_t>&) { return true; }

  recording::TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_ / "run.mcap";
  recording::Metadata origin_{{"clock", "lockstep"}, {"controller", "gain_scheduling_partial"}};
};

TEST_F(RefusedRecording, TheUnchangedCopyIsReplayed) { EXPECT_EQ(reason_with(origin_), "replayed"); }

TEST_F(RefusedRecording, OfARecorderWithoutRigFileAndController) {
  const auto file = directory_ / "recorder.mcap";
  bus::Options options;
  options.vendor = bus::Vendor::memory;
  options.network = bus::make_memory_network();
  options.source = crane_SOURCE_RECORDER;
  bus::Bus bus{options};
  recorder::Recorder recorder{bus, {.file = file}};
  ASSERT_TRUE(recorder.close());
  const auto reason = reason_of(file);
  EXPECT_NE(reason.find("rig.toml: no such attachment"), std::string::npos) << reason;
  EXPECT_NE(reason.find("controller: missing"), std::string::npos) << "all reasons at once: " << reason;
}

TEST_F(RefusedRecording, OfProgramsThatDidNotPublishWhatTheSupervisorAccepted) {
  const auto file = directory_ / "earlier.mcap";
  recording::McapWriter writer{file};
  const auto& node = topics::node.description;
  (void)writer.channel(writer.schema(std::string{node.type}, "omgidl", std::string{topics::idl_text()}),
                       std::string{node.name}, "cdr");
  writer.close();
  const auto reason = reason_of(file);
  EXPECT_NE(reason.find("crane/accepted_request: no such topic"), std::string::npos) << reason;
  EXPECT_NE(reason.find("crane/accepted_jog: no such topic"), std::string::npos) << reason;
}

TEST_F(RefusedRecording, WithASchemaThatHasLostItsVersion) {
  const auto file = directory_ / "damaged.mcap";
  recording::McapWriter writer{file};
  std::string text{topics::idl_text()};
  const std::string constant = "uint32 MESSAGES_VERSION";
  text[text.find(constant) + constant.size() - 1] ^= 1;
  const auto& node = topics::node.description;
  (void)writer.channel(writer.schema(std::string{node.type}, "omgidl", text), std::string{node.name}, "cdr");
  writer.close();
  const auto reason = reason_of(file);
  EXPECT_NE(reason.find("messages without a version"), std::string::npos) << reason;
}

TEST_F(RefusedRecording, WithAnUnknownController) {
  origin_["controller"] = "bang_bang";
  EXPECT_NE(reason_with(origin_).find("controller = bang_bang: this program has no such controller"),
            std::string::npos);
}

TEST_F(RefusedRecording, ThatBeginsLater) {
  const auto reason = reason_with(origin_, [](const recording::Message& message, std::vector<std::uint8_t>&) {
    return message.sequence >= 20;
  });
  EXPECT_NE(reason.find("begins with tick 20; a replay needs tick 0"), std::string::npos) << reason;
}

TEST_F(RefusedRecording, WithTwoSamplesOfATick) {
  const auto copy = directory_ / "doubled.mcap";
  recording::McapReader reader{file_};
  recording::McapWriter writer{copy};
  const auto channels = recording::add_topic_channels(writer);
  for (const auto& record : reader.metadata()) writer.metadata(record.name, record.entries);
  for (const auto& each : reader.attachments())
    writer.attachment(each.name, each.media_type, each.time_ns, each.data);
  reader.for_each({}, [&](const recording::Message& message) {
    for (int i = 0; i < 2; ++i)
      writer.message(channels[message.channel->id], message.sequence, message.log_time_ns,
                     message.publish_time_ns, message.data);
    return true;
  });
  writer.close();
  EXPECT_NE(reason_of(copy).find("two samples of crane/state"), std::string::npos);
}

TEST_F(RefusedRecording, ThatIsNotARecording) {
  recording::put_contents(directory_ / "text.mcap", "no recording");
  EXPECT_THROW((void)replay::replay(directory_ / "text.mcap", replay::loop_components()),
               recording::ReadError);
}

}  // namespace
}  // namespace crane::replay_test
