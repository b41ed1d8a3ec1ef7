#pragma once
/// The driver of the Servo-to-Go card, as for a real card, on an emulated card with an emulated rig.
#include <memory>

#include "crane/boards/emulated_rig.hpp"
#include "crane/boards/servo_to_go.hpp"

namespace crane::bridge {

class EmulatedBoard : public Board {
 public:
  EmulatedBoard(const configuration::Rig& rig, std::unique_ptr<EmulatedRig> connected);

  [[nodiscard]] std::string_view name() const override { return driver_.name(); }
  [[nodiscard]] Inputs read() override;
  std::array<double, kDrives> write(const Outputs& outputs) override { return driver_.write(outputs); }
  void make_safe() noexcept override { driver_.make_safe(); }
  void advance_to(std::int64_t time_ns) override { rig_->advance_to(time_ns); }
  [[nodiscard]] bool simulates_time() const override { return true; }
  bool kick(double radial_radps, double tangential_radps) override;

 private:
  std::unique_ptr<EmulatedRig> rig_;
  ServoToGo driver_;
};

}  // namespace crane::bridge
