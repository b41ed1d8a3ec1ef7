#pragma once
/// Assignment of digital lines to signals, for all cards with digital lines.
#include "crane/bridge/board.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bridge {

class RigLines {
 public:
  explicit RigLines(const configuration::Rig& rig);
  /// Sets all inputs except the counts. Inputs are normally closed contacts to ground: a low line is a closed
  /// contact. @param levels  bit n: level of input line n, 0..15
  void read(std::uint32_t levels, Inputs& inputs) const noexcept;
  /// @return bit n: output line n, 16..31, is on; all other bits are 0
  [[nodiscard]] std::uint32_t outputs(const Outputs& outputs) const noexcept;
  [[nodiscard]] bool present(std::size_t drive) const { return present_[drive]; }

 private:
  configuration::Wiring wiring_;
  std::array<bool, kDrives> present_{};
};

}  // namespace crane::bridge
