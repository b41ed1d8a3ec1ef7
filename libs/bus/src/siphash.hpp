#pragma once
/// SipHash-2-4: a keyed hash of 64 bits (J.-P. Aumasson, D. J. Bernstein: SipHash: a fast short-input PRF,
/// 2012).
#include <array>
#include <cstdint>
#include <span>

namespace crane::bus {

using SipKey = std::array<std::uint64_t, 2>;

[[nodiscard]] std::uint64_t siphash(const SipKey& key, std::span<const std::uint8_t> bytes) noexcept;

}  // namespace crane::bus
