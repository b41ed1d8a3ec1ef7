#pragma once
/// x86 port input and output as a seam: the real instructions, or a card that is emulated.
#include <cstdint>
#include <memory>

#include "crane/bridge/board.hpp"

namespace crane::bridge {

class PortIo {
 public:
  virtual ~PortIo() = default;
  [[nodiscard]] virtual std::uint8_t in_8(std::uint16_t port) noexcept = 0;
  [[nodiscard]] virtual std::uint16_t in_16(std::uint16_t port) noexcept = 0;
  virtual void out_8(std::uint16_t port, std::uint8_t value) noexcept = 0;
  virtual void out_16(std::uint16_t port, std::uint16_t value) noexcept = 0;
};

/// inb, inw, outb, outw of this machine, for the two windows of the card at `base_address`.
/// @throws BoardError without permission, or where there are no ports
[[nodiscard]] std::unique_ptr<PortIo> open_ports(std::uint16_t base_address);

}  // namespace crane::bridge
