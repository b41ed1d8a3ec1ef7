#pragma once
/// An emulated Servo-to-Go card behind a driver whose port accesses are recorded.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <ostream>
#include <vector>

#include "crane/boards/servo_to_go.hpp"
#include "subject.hpp"

namespace crane::bridge::test {

struct Access {
  char kind;  ///< 'r', 'w' of 8 bits, 'W' of 16
  unsigned port, value;
  friend bool operator==(const Access&, const Access&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Access& access) {
    return out << access.kind << std::hex << " 0x" << access.port << " 0x" << access.value << std::dec;
  }
};

/// Passes accesses to a card and records them.
class Tapped final : public PortIo {
 public:
  using Before = std::function<void(const Access&)>;
  Tapped(PortIo& card, std::vector<Access>& log, Before before = {})
      : card_{card}, log_{log}, before_{std::move(before)} {}
  std::uint8_t in_8(std::uint16_t port) noexcept override {
    note({'r', port, 0});
    return card_.in_8(port);
  }
  std::uint16_t in_16(std::uint16_t port) noexcept override {
    note({'R', port, 0});
    return card_.in_16(port);
  }
  void out_8(std::uint16_t port, std::uint8_t value) noexcept override {
    note({'w', port, value});
    card_.out_8(port, value);
  }
  void out_16(std::uint16_t port, std::uint16_t value) noexcept override {
    note({'W', port, value});
    card_.out_16(port, value);
  }

 private:
  void note(const Access& access) {
    if (before_) before_(access);
    log_.push_back(access);
  }
  PortIo& card_;
  std::vector<Access>& log_;
  Before before_;
};

/// A connector whose encoders the test moves.
struct Plug final : Connector {
  std::array<std::int32_t, kCardChannels> turned{};
  std::array<std::uint16_t, kCardChannels> codes{};
  std::uint16_t in = 0xFFFF, out = 0;
  std::int64_t time_ns = 0;
  std::int32_t pulses(std::size_t channel) noexcept override { return turned[channel]; }
  std::uint16_t inputs() noexcept override { return in; }
  void set_converter(std::size_t channel, std::uint16_t code) noexcept override { codes[channel] = code; }
  void set_outputs(std::uint16_t levels) noexcept override { out = levels; }
  std::int64_t now_ns() noexcept override { return time_ns; }
};

class Card : public testing::Test {
 protected:
  std::unique_ptr<ServoToGo> open(Tapped::Before before = {}) {
    return std::make_unique<ServoToGo>(rig_, std::make_unique<Tapped>(card_, log_, std::move(before)));
  }
  std::vector<Access> accesses_to(std::initializer_list<unsigned> ports) const {
    std::vector<Access> found;
    for (const auto& access : log_)
      if (std::find(ports.begin(), ports.end(), access.port) != ports.end()) found.push_back(access);
    return found;
  }
  configuration::Rig rig_ = emulated_rig();
  CardState state_;
  Plug plug_;
  EmulatedServoToGo card_{0x200, state_, plug_};
  std::vector<Access> log_;
};

}  // namespace crane::bridge::test
