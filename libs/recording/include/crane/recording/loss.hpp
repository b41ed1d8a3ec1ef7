#pragma once
/// Samples that are missing in a recording: which topic, how many, when and why. The recorder writes them to
/// the channel recorder/loss of the recording, so that commands which cut, merge or export a recording keep
/// them.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "crane/recording/mcap_reader.hpp"

namespace crane::recording {

/// Cause of a loss. docs/data.md#missing-samples describes each.
enum class LossCause : std::uint8_t { queue_full, dds_lost, wrong_crc, file_removed, tick_gap };
[[nodiscard]] std::string_view to_string(LossCause cause);

struct Loss {
  std::string topic;
  LossCause cause = LossCause::queue_full;
  std::uint64_t samples = 0;
  /// log times at which the recorder noticed the first and the last missing sample
  std::int64_t from_ns = 0, until_ns = 0;
};

inline constexpr std::string_view kLossTopic = "recorder/loss";

/// Adds the channel recorder/loss. @return its id
std::uint16_t add_loss_channel(McapWriter& writer);
/// Writes a loss at the log time `until_ns`. @throws WriteError
void write_loss(McapWriter& writer, std::uint16_t channel, const Loss& loss);

[[nodiscard]] bool has_losses_channel(const McapReader& recording);
/// All losses in the order of log time. @throws DecodeError, SchemaError
[[nodiscard]] std::vector<Loss> losses_in(McapReader& recording);

}  // namespace crane::recording
