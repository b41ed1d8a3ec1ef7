#pragma once
/// Interface for x86 port input and output: the real instructions, or an emulated card.
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

/// Port access with inb, inw, outb, outw for the two windows of the card at `base_address`.
/// @throws BoardError without permission, or on a computer without I/O ports
[[nodiscard]] std::unique_ptr<PortIo> open_ports(std::uint16_t base_address);

}  // namespace crane::bridge
