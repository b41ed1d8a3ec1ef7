#include "black_box/incident_file.hpp"

#include <gmock/gmock.h>

#include "../observation/samples.hpp"
#include "../recording/temporary_directory.hpp"
#include "crane/recording/mcap_reader.hpp"

namespace crane::black_box {
namespace {

using observation::kSecond_ns;

Incident an_incident() {
  constexpr std::int64_t kAt_ns = 1'795'579'498 * kSecond_ns;
  Incident incident{
      .from_ns = kAt_ns - kSecond_ns, .until_ns = kAt_ns + kSecond_ns, .first = {}, .samples = {}};
  incident.first.at_ns = kAt_ns;
  incident.first.what = "LATCH_encoder jump";
  incident.samples = {observation::status_at(kAt_ns, crane_STATE_STOP_C0, crane_CAUSE_BRIDGE_LATCHED, 7)};
  return incident;
}

TEST(IncidentFile, HasSamplesTriggerProcessesAndTheRigFile) {
  const recording::TemporaryDirectory directory;
  const auto file =
      write_incident(directory / "", an_incident(),
                     {.crane = {{"version", "1"}}, .rig_name = "rig.toml", .rig_text = "name = 1"},
                     {{"supervisor", "1, cyclone"}});
  EXPECT_EQ(file.filename(), "20261125T040458Z_LATCH_encoder_jump.mcap");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator{directory / ""}, {}), 1)
      << "no unfinished file";
  EXPECT_EQ(recording::check(file).messages, 1U);
  recording::McapReader reader{file};
  ASSERT_EQ(reader.attachments().size(), 1U);
  EXPECT_EQ(reader.attachments()[0].name, "rig.toml");
  const auto metadata = reader.metadata();
  ASSERT_EQ(metadata.size(), 3U);
  EXPECT_EQ(metadata[1].entries.at("first_cause"), "LATCH_encoder jump");
  EXPECT_EQ(metadata[2].entries.at("supervisor"), "1, cyclone");
}

/// A fault that lasts longer than one file, or a second crane that stops in the same second.
TEST(IncidentFile, DoesNotReplaceAnotherFileOfItsName) {
  const recording::TemporaryDirectory directory;
  auto second = an_incident();
  second.samples.clear();
  const auto first_file = write_incident(directory / "", an_incident(), {}, {});
  const auto second_file = write_incident(directory / "", second, {}, {});
  EXPECT_EQ(second_file.filename(), "20261125T040458Z_LATCH_encoder_jump_2.mcap");
  EXPECT_EQ(recording::check(first_file).messages, 1U);
  EXPECT_EQ(recording::check(second_file).messages, 0U);
}

TEST(IncidentFile, OfAnotherProcessThatIsStillWritingIsKept) {
  const recording::TemporaryDirectory directory;
  const auto unfinished = [](pid_t pid) { return "20260101T000000Z_A." + std::to_string(pid) + ".part"; };
  constexpr pid_t kNoProcess = 999'999'999;
  const auto is_kept = [&](pid_t pid, std::chrono::minutes age) {
    recording::put_contents(directory / unfinished(pid), "");
    std::filesystem::last_write_time(directory / unfinished(pid),
                                     std::filesystem::file_time_type::clock::now() - age);
    keep_newest(directory / "", 2, directory / "");
    return std::filesystem::exists(directory / unfinished(pid));
  };
  EXPECT_TRUE(is_kept(getpid(), std::chrono::minutes{60}));
  EXPECT_TRUE(is_kept(kNoProcess, std::chrono::minutes{1})) << "a process of another host";
  EXPECT_FALSE(is_kept(kNoProcess, std::chrono::minutes{60}));
}

std::vector<std::string> files_in(const std::filesystem::path& directory) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator{directory})
    names.push_back(entry.path().filename());
  return names;
}

TEST(IncidentFile, KeepsOnlyTheNewestOfItsOwnFiles) {
  const recording::TemporaryDirectory directory;
  for (const auto* name : {"20260101T000000Z_A.mcap", "20260102T000000Z_B.mcap", "20260103T000000Z_C.mcap",
                           "20250101T000000Z_C.html", "run.mcap"})
    recording::put_contents(directory / name, "");
  keep_newest(directory / "", 2, directory / "20260103T000000Z_C.mcap");
  EXPECT_THAT(files_in(directory / ""),
              testing::UnorderedElementsAre("20260102T000000Z_B.mcap", "20260103T000000Z_C.mcap",
                                            "20250101T000000Z_C.html", "run.mcap"));
}

/// The clock is set back by a year after B. Names and modification times of the later files lie before those
/// of the earlier ones.
TEST(IncidentFile, KeepsTheFilesThatWereWrittenLastAfterTheClockWasSetBack) {
  const recording::TemporaryDirectory directory;
  const auto now = std::filesystem::file_time_type::clock::now();
  const auto write = [&](const char* name, std::chrono::hours after) {
    recording::put_contents(directory / name, "");
    std::filesystem::last_write_time(directory / name, now + after);
    keep_newest(directory / "", 2, directory / name);
  };
  write("20260101T000000Z_A.mcap", std::chrono::hours{-2});
  write("20260101T010000Z_B.mcap", std::chrono::hours{-1});
  write("20250101T020000Z_C.mcap", std::chrono::hours{-8760});
  EXPECT_THAT(files_in(directory / ""),
              testing::UnorderedElementsAre("20260101T010000Z_B.mcap", "20250101T020000Z_C.mcap"));
  write("20250101T030000Z_D.mcap", std::chrono::hours{-8759});
  EXPECT_THAT(files_in(directory / ""),
              testing::UnorderedElementsAre("20250101T020000Z_C.mcap", "20250101T030000Z_D.mcap"));
  write("20250101T010000Z_E.mcap", std::chrono::hours{-8761});
  EXPECT_THAT(files_in(directory / ""),
              testing::UnorderedElementsAre("20250101T030000Z_D.mcap", "20250101T010000Z_E.mcap"));
}

TEST(IncidentFile, IsWrittenAlsoIfItsDirectoryHasBeenDeleted) {
  const recording::TemporaryDirectory directory;
  const auto file = write_incident(directory / "deleted/black_box", an_incident(), {}, {});
  EXPECT_EQ(recording::check(file).messages, 1U);
}

}  // namespace
}  // namespace crane::black_box
