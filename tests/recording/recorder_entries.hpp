#pragma once
/// Entries and files for the tests of the recorder.
#include <filesystem>
#include <random>
#include <utility>

#include "recorder/recording_thread.hpp"

namespace crane::recorder {

inline Entry entry(std::uint32_t number, std::size_t bytes = 16, std::uint16_t channel = 0) {
  std::mt19937 random{number};  // random bytes do not compress, so that the file grows by their size
  Entry result;
  result.channel = channel;
  result.sequence = number;
  result.log_time_ns = number;
  result.data.resize(bytes);
  for (auto& byte : result.data) byte = static_cast<std::uint8_t>(random());
  return result;
}

/// Files with two channels, one metadata record and one attachment.
inline RecordingFiles files_for(const std::filesystem::path& file, const Limits& limits = {}) {
  return {file, limits, [](recording::McapWriter& writer) {
            writer.channel(0, "test", "none");
            writer.channel(0, "other", "none");
            writer.metadata("crane", {{"started_ns", "1"}});
            const std::array<std::uint8_t, 3> rig{'a', '=', '1'};
            writer.attachment("rig.toml", "application/toml", 1, rig);
            return std::vector<std::string>{"test", "other"};
          }};
}

/// Sequence numbers of the messages of the topics "test" and "other".
inline std::vector<std::uint32_t> sequences_in(const std::filesystem::path& recording) {
  std::vector<std::uint32_t> sequences;
  recording::McapReader reader{recording};
  reader.for_each({.topics = {"test", "other"}}, [&](const recording::Message& message) {
    sequences.push_back(message.sequence);
    return true;
  });
  return sequences;
}

}  // namespace crane::recorder
