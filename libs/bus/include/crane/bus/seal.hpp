#pragma once
/// Source, epoch and checksum of a sample. Publishers and subscribers call these functions; tests use them to
/// forge and check samples.
#include <cstdint>
#include <span>

#include "crane/topics.hpp"

namespace crane::bus {

/// Writes source, epoch and CRC into `sample`. The CRC also covers the name of the topic and the version of
/// the messages: a sample of another topic or of another version has a wrong CRC, even if its layout is the
/// same.
void seal(const topics::Description& topic, void* sample, crane_Source source, std::uint32_t epoch,
          std::uint32_t messages_version = crane_MESSAGES_VERSION);
/// Bytes of a sealed sample for the ledger: its encoding, the name of the topic and the version of the
/// messages. Valid until the next call in this thread; empty when the sample cannot be encoded.
[[nodiscard]] std::span<const std::uint8_t> ledger_entry(const topics::Description& topic, const void* sample,
                                                         std::uint32_t messages_version);
/// @return true when the CRC of the sample is correct for this topic and version
[[nodiscard]] bool intact(const topics::Description& topic, const void* sample,
                          std::uint32_t messages_version = crane_MESSAGES_VERSION);

}  // namespace crane::bus
