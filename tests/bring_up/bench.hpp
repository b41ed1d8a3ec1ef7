#pragma once
/// An emulated rig wired according to one rig file. The bring-up uses another rig file.
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>

#include "crane/boards/emulated_board.hpp"
#include "crane/bring_up/selftest.hpp"
#include "crane/emulated_rig/wired_rig.hpp"

namespace crane::bring_up::test {

/// The rig of deploy/rigs/emulated_servo_to_go.toml.
inline configuration::Rig tower() { return configuration::load_rig(CRANE_RIGS "/emulated_servo_to_go.toml"); }

/// Lines that are stuck at a level; bits as on the connector.
struct StuckLines {
  std::uint16_t outputs_on = 0, outputs_off = 0;  ///< bit 0: line 16
  std::uint16_t inputs_closed = 0, inputs_open = 0;
};

class StuckRig final : public bridge::EmulatedRig {
 public:
  StuckRig(const configuration::Rig& rig, const StuckLines& stuck) : rig_{rig}, stuck_{stuck} {}

  std::int32_t pulses(std::size_t channel) noexcept override { return rig_.pulses(channel); }
  std::uint16_t inputs() noexcept override {  // a closed contact is low
    return static_cast<std::uint16_t>((rig_.inputs() & ~stuck_.inputs_closed) | stuck_.inputs_open);
  }
  void set_converter(std::size_t channel, std::uint16_t code) noexcept override {
    rig_.set_converter(channel, code);
  }
  void set_outputs(std::uint16_t levels) noexcept override {
    rig_.set_outputs(static_cast<std::uint16_t>((levels & ~stuck_.outputs_off) | stuck_.outputs_on));
  }
  std::int64_t now_ns() noexcept override { return rig_.now_ns(); }
  bridge::CardState& card() noexcept override { return rig_.card(); }
  void advance_to(std::int64_t time_ns) override { rig_.advance_to(time_ns); }
  void kick(double radial_radps, double tangential_radps) override {
    rig_.kick(radial_radps, tangential_radps);
  }
  void require_alive() override {}

  [[nodiscard]] emulated_rig::WiredRig& wired() { return rig_; }

 private:
  emulated_rig::WiredRig rig_;
  StuckLines stuck_;
};

class Bench {
 public:
  Bench(const configuration::Rig& stated, const configuration::Rig& wired, const StuckLines& stuck = {},
        Clock clock = {}) {
    auto rig = std::make_unique<StuckRig>(wired, stuck);
    rig_ = rig.get();
    stated_ = stated;
    board_ = std::make_unique<bridge::EmulatedBoard>(stated_, std::move(rig));
    session_ = std::make_unique<Session>(stated_, *board_, std::move(clock));
  }
  [[nodiscard]] Session& session() { return *session_; }
  void end_session() { session_.reset(); }
  [[nodiscard]] emulated_rig::WiredRig& rig() { return rig_->wired(); }
  [[nodiscard]] const configuration::Rig& stated() const { return stated_; }
  void pass(std::int64_t duration_ns) { rig_->advance_to(rig_->now_ns() + duration_ns); }
  void expect_safe() {
    EXPECT_EQ(rig().drive_v(), (std::array<double, kDrives>{}));
    pass(50'000'000);
    EXPECT_EQ(rig().crane().read().brake_closed, (std::array<bool, kDrives>{true, true, true}));
  }

 private:
  configuration::Rig stated_;
  StuckRig* rig_;
  std::unique_ptr<bridge::EmulatedBoard> board_;
  std::unique_ptr<Session> session_;
};

}  // namespace crane::bring_up::test
