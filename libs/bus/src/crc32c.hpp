#pragma once
/// CRC-32C (Castagnoli: reflected polynomial 0x1EDC6F41, start and final exclusive-or 0xFFFFFFFF).
#include <cstdint>
#include <span>

namespace crane::bus {

/// CRC-32C of `bytes`; uses the CRC instruction of the processor where it exists.
[[nodiscard]] std::uint32_t crc32c(std::span<const std::uint8_t> bytes);
/// CRC-32C of `bytes`, computed with Boost.CRC on any processor.
[[nodiscard]] std::uint32_t crc32c_portable(std::span<const std::uint8_t> bytes);

}  // namespace crane::bus
