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

enum class LossCause : std::uint8_t {
  queue_full,    ///< the recorder dropped the samples: its disk was too slow
  dds_lost,      ///< DDS reported the samples as lost (SAMPLE_LOST)
  wrong_crc,     ///< the recorder rejected the samples: their CRC-32C was wrong
  file_removed,  ///< the file that contained the samples was deleted while the recorder wrote it
  tick_gap       ///< ticks are missing between two samples of a writer without any other cause: the recorder
                 ///< paused until its reader overwrote samples, or the loop was late and skipped the ticks
};
[[nodiscard]] std::string_view to_string(LossCause cause);

struct Loss {
  std::string topic;
  LossCause cause = LossCause::queue_full;
  std::uint64_t samples = 0;
  std::int64_t from_ns = 0, until_ns = 0;  ///< log times at which the recorder noticed the first and the last
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
