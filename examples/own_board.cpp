/// Adds a board to the hardware bridge without a change to the project: three motors without friction and
/// load. The example runs the whole stack with this board in lockstep and moves the trolley by 10 cm.
#include <cmath>
#include <cstdio>
#include <optional>

#include "crane/bridge/bridge.hpp"
#include "experiments/experiment_run.hpp"
#include "stack/data_files.hpp"

namespace {

using namespace crane;

/// Three motors whose acceleration is proportional to the voltage. Simulated time passes only in
/// advance_to().
class MotorBench final : public bridge::Board {
 public:
  explicit MotorBench(const configuration::Rig& rig) : rig_{rig} {
    for (std::size_t i = 0; i < bridge::kDrives; ++i) position_[i] = rig.start.position[i];
  }

  [[nodiscard]] std::string_view name() const override { return "motor_bench"; }

  [[nodiscard]] bridge::Inputs read() override {
    bridge::Inputs inputs;
    for (std::size_t i = 0; i < bridge::kDrives; ++i) {
      const auto& encoder = rig_.encoders[i];
      inputs.raw_counts[i] =
          static_cast<std::int32_t>(std::lround(position_[i] * encoder.counts_per_unit)) * encoder.sign;
      inputs.brake_closed[i] = !released(i);
    }
    inputs.watchdog_dropped = relay_is_open();
    return inputs;
  }
  std::array<double, bridge::kDrives> write(const bridge::Outputs& outputs) override {
    if (outputs.watchdog_level != outputs_.watchdog_level) toggled_ns_ = now_ns_;
    outputs_ = outputs;
    return outputs.drive_v;
  }
  void make_safe() noexcept override { outputs_ = {}; }

  void advance_to(std::int64_t time_ns) override {
    const double step_s = static_cast<double>(time_ns - now_ns_) * 1e-9;
    now_ns_ = time_ns;
    for (std::size_t i = 0; i < bridge::kDrives; ++i) {
      if (!released(i)) speed_[i] = 0;
      const double acceleration = released(i) ? kGain[i] * outputs_.drive_v[i] * rig_.drives[i].sign : 0;
      position_[i] += step_s * (speed_[i] + 0.5 * step_s * acceleration);
      speed_[i] += step_s * acceleration;
    }
  }
  [[nodiscard]] bool simulates_time() const override { return true; }

 private:
  [[nodiscard]] bool relay_is_open() const {
    return !toggled_ns_ || static_cast<double>(now_ns_ - *toggled_ns_) * 1e-9 > rig_.wiring.relay_timeout_s;
  }
  [[nodiscard]] bool released(std::size_t drive) const {
    return outputs_.brake_release[drive] && !relay_is_open();
  }

  static constexpr std::array kGain{0.7, 0.5, 0.7};  // m/s^2 per V, rad/s^2 per V, m/s^2 per V
  configuration::Rig rig_;
  bridge::Outputs outputs_;
  std::array<double, bridge::kDrives> position_{}, speed_{};
  std::int64_t now_ns_ = 0;
  std::optional<std::int64_t> toggled_ns_;  ///< last change of the watchdog output
};

}  // namespace

int main() {
  auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower"));
  for (auto& friction : rig.design.friction) friction.factor = 0;  // the motors have no friction
  auto components = stack::hardware_stack();
  components.front().make = [](const runtime::Context& context) -> std::unique_ptr<runtime::Component> {
    return std::make_unique<bridge::Bridge>(context, std::make_unique<MotorBench>(context.rig));
  };
  experiment::Scenario scenario;
  scenario.moves.push_back(
      {.at_s = 0.5, .target = {rig.start.position[0] + 0.1, std::nullopt, std::nullopt}});
  scenario.duration_s = 5;
  experiments::TickLog log{std::nullopt};
  const auto outcome =
      experiments::run_in_process(components, rig, *control::find_controller("none"), scenario, log);
  const auto table = log.table(outcome.hold_tick);
  std::printf("%s: trolley from %.3f m to %.3f m\n",
              outcome.completed ? "done" : outcome.stopped_because.c_str(),
              table.find("trolley_position_m")->front(), table.find("trolley_position_m")->back());
  return outcome.completed ? 0 : 1;
}
