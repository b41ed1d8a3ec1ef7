#include "crane/recording/mcap_reader.hpp"
#include "recording_copy.hpp"

namespace crane::recording {

CheckReport check(const std::filesystem::path& file) {
  McapReader reader{file};
  CheckReport report;
  reader.for_each({}, [&](const Message&) {
    ++report.messages;
    return true;
  });
  (void)reader.metadata();
  (void)reader.attachments();
  report.problems = reader.problems();
  return report;
}

CheckReport repair(const std::filesystem::path& damaged, const std::filesystem::path& repaired) {
  McapReader reader{damaged};
  RecordingCopy copy{repaired, reader.files()};
  const auto channels = copy.add_channels(reader);
  auto messages = reader.messages();
  while (const auto* message = messages.next()) copy.add(*message, channels);
  copy.add_attachments(reader);
  CheckReport report;
  report.messages = copy.finish();
  report.problems = reader.problems();
  return report;
}

}  // namespace crane::recording
