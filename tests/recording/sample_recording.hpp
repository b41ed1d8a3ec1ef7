#pragma once
/// A small recording with known content for the tests of writer, reader and repair.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "crane/recording/mcap_reader.hpp"
#include "crane/recording/mcap_writer.hpp"

namespace crane::recording {

inline constexpr std::int64_t kStart_ns = 5'000'000'000;
inline constexpr std::int64_t kTick_ns = 10'000'000;

inline std::vector<std::uint8_t> payload_of(std::uint32_t sequence) {
  // Hardly compressible, so that chunks have some length: a linear congruential sequence.
  std::vector<std::uint8_t> bytes{0, 1, 0, 0};
  std::uint32_t value = sequence * 2654435761U + 1;
  for (int i = 0; i < 96; ++i) {
    value = value * 1664525U + 1013904223U;
    bytes.push_back(static_cast<std::uint8_t>(value >> 24U));
  }
  return bytes;
}

/// Messages 0 .. count-1, one per tick, in turn on two channels; one metadata record, one attachment at the
/// end.
inline void write_sample(const std::filesystem::path& file, std::uint32_t count,
                         const WriterOptions& options = {}) {
  McapWriter writer{file, options};
  const auto schema = writer.schema("crane::CraneState", "omgidl", "module crane {};");
  const std::uint16_t first = writer.channel(schema, "crane/state", "cdr", {{"unit", "SI"}});
  const std::uint16_t second = writer.channel(0, "crane/note", "json");
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::int64_t time_ns = kStart_ns + kTick_ns * i;
    writer.message(i % 2 == 0 ? first : second, i, time_ns, time_ns + 7, payload_of(i));
  }
  writer.metadata("run", {{"rig", "virginia_tech_tower"}});
  const std::string rig = "period_s = 0.01\n";
  writer.attachment("rig.toml", "application/toml", kStart_ns,
                    {reinterpret_cast<const std::uint8_t*>(rig.data()), rig.size()});
  writer.close();
}

/// Sequence numbers of all readable messages; content and times must be those of write_sample().
inline std::vector<std::uint32_t> sequences_in(McapReader& reader, bool* genuine,
                                               const Selection& selection = {}) {
  std::vector<std::uint32_t> sequences;
  *genuine = true;
  reader.for_each(selection, [&](const Message& message) {
    const std::vector<std::uint8_t> expected = payload_of(message.sequence);
    *genuine = *genuine &&
               std::equal(message.data.begin(), message.data.end(), expected.begin(), expected.end()) &&
               message.log_time_ns == kStart_ns + kTick_ns * message.sequence &&
               message.publish_time_ns == message.log_time_ns + 7 &&
               message.channel->topic == (message.sequence % 2 == 0 ? "crane/state" : "crane/note");
    sequences.push_back(message.sequence);
    return true;
  });
  return sequences;
}

/// 0, 1, ... count-1
inline std::vector<std::uint32_t> first_numbers(std::size_t count) {
  std::vector<std::uint32_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::uint32_t>(i);
  return numbers;
}

}  // namespace crane::recording
