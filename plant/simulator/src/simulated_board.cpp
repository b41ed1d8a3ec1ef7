#include "crane/simulator/simulated_board.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "brake_supply.hpp"
#include "crane/bridge/converter.hpp"
#include "mechanism.hpp"

namespace crane::simulator {
namespace {

using plant::Axis;

constexpr std::int64_t kLongestSpan_ns = 10'000'000;

std::int64_t to_ns(double seconds) { return std::llround(seconds * 1e9); }

BrakeCoil coil_of(const SimulatedDrive& drive) {
  return {to_ns(drive.brake_close_time_s), to_ns(drive.brake_open_time_s)};
}

}  // namespace

std::int32_t wrap_24_bit(std::int64_t counts) noexcept {
  const auto low = static_cast<std::int32_t>(counts & 0xFFFFFF);
  return low >= 0x800000 ? low - 0x1000000 : low;
}

struct SimulatedBoard::Rig {
  Rig(const SimulatedRig& description, std::int64_t start_time_ns, const Tolerances& tolerances)
      : given(description),
        mechanism(description, tolerances),
        relay(to_ns(description.watchdog_timeout_s), to_ns(description.watchdog_permit_s)),
        coils{coil_of(given.drives[0]), coil_of(given.drives[1]), coil_of(given.drives[2])},
        period_ns(std::max<std::int64_t>(1, to_ns(description.period_s))),
        now_ns(start_time_ns) {}

  /// Updates relay, coils and brakes for the present time.
  void settle() noexcept {
    relay.let_time_pass(now_ns);
    const bool supply = relay.closed() && !(estop_pressed && given.estop_cuts_brakes);
    for (std::size_t i = 0; i < coils.size(); ++i) {
      coils[i].set_supply(supply && outputs.brake_release[i], now_ns);
      coils[i].let_time_pass(now_ns);
      mechanism.set_brake(static_cast<Axis>(i), coils[i].closed());
    }
  }

  /// Command terms act once per tick on the last written command.
  void begin_tick_if_due() noexcept {
    if (!command_is_new && now_ns < tick_ends_ns) return;
    mechanism.begin_tick(converter_v);
    command_is_new = false;
    tick_ends_ns = now_ns + period_ns;
  }

  /// The sensor terms act at the first read at a time; a second read at the same time returns the
  /// same values.
  [[nodiscard]] const plant::Measurement& measured() noexcept {
    if (measured_at_ns != now_ns) measurement = mechanism.measure();
    measured_at_ns = now_ns;
    return measurement;
  }

  [[nodiscard]] std::int64_t next_change_ns() const {
    std::int64_t next = std::min({relay.drops_at_ns(), now_ns + kLongestSpan_ns, tick_ends_ns});
    for (const BrakeCoil& coil : coils) next = std::min(next, coil.changes_at_ns());
    return next;
  }

  SimulatedRig given;
  Mechanism mechanism;
  WatchdogRelay relay;
  std::array<BrakeCoil, bridge::kDrives> coils;
  bridge::Outputs outputs;
  std::array<double, bridge::kDrives> converter_v{};
  bool estop_pressed = false, command_is_new = true;
  plant::Measurement measurement;
  std::optional<std::int64_t> measured_at_ns;
  std::int64_t period_ns;
  std::int64_t now_ns, tick_ends_ns = 0;
};

SimulatedBoard::SimulatedBoard(const SimulatedRig& rig, std::int64_t start_time_ns,
                               const Tolerances& tolerances)
    : rig_(std::make_unique<Rig>(rig, start_time_ns, tolerances)) {}
SimulatedBoard::~SimulatedBoard() = default;

bridge::Inputs SimulatedBoard::read() {
  const plant::State& s = rig_->mechanism.state();
  const plant::Measurement& m = rig_->measured();
  const std::array<double, bridge::kCounters> coordinates{m.trolley_m, m.slew_rad, m.cable_m, m.radial_rad,
                                                          m.tangential_rad};
  bridge::Inputs inputs;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const SimulatedEncoder& encoder = rig_->given.encoders[i];
    const double shown = coordinates[i] - encoder.zero;
    inputs.raw_counts[i] = wrap_24_bit(std::llround(encoder.sign * shown * encoder.counts_per_unit));
  }
  for (std::size_t i = 0; i < bridge::kDrives; ++i) {
    const SimulatedDrive& drive = rig_->given.drives[i];
    const double at = plant::position(s, static_cast<Axis>(i));
    inputs.limit_low[i] = at <= drive.low_switch;
    inputs.limit_high[i] = at >= drive.high_switch;
    inputs.mark[i] = at <= drive.mark;
    inputs.brake_closed[i] = rig_->coils[i].closed();
  }
  inputs.estop_pressed = rig_->estop_pressed;
  inputs.watchdog_dropped = !rig_->relay.closed();
  return inputs;
}

std::array<double, bridge::kDrives> SimulatedBoard::write(const bridge::Outputs& outputs) {
  rig_->outputs = outputs;
  for (std::size_t i = 0; i < bridge::kDrives; ++i) {
    rig_->converter_v[i] = bridge::converter_voltage_v(bridge::converter_code(outputs.drive_v[i]));
  }
  rig_->command_is_new = true;
  rig_->relay.set_level(outputs.watchdog_level, rig_->now_ns);
  rig_->settle();
  return rig_->converter_v;
}

void SimulatedBoard::make_safe() noexcept {
  rig_->outputs = {};
  rig_->converter_v = {};
  rig_->command_is_new = true;
  rig_->relay.set_level(false, rig_->now_ns);
  rig_->settle();
}

void SimulatedBoard::advance_to(std::int64_t time_ns) {
  while (rig_->now_ns < time_ns) {
    rig_->begin_tick_if_due();
    const std::int64_t until_ns = std::min(time_ns, rig_->next_change_ns());
    rig_->mechanism.run(static_cast<double>(until_ns - rig_->now_ns) * 1e-9);
    rig_->now_ns = until_ns;
    rig_->settle();
  }
}

void SimulatedBoard::press_estop(bool pressed) noexcept {
  rig_->estop_pressed = pressed;
  rig_->settle();
}

bool SimulatedBoard::kick(double radial_radps, double tangential_radps) {
  rig_->mechanism.kick(radial_radps, tangential_radps);
  return true;
}

const std::array<double, bridge::kDrives>& SimulatedBoard::converter_v() const noexcept {
  return rig_->converter_v;
}
const plant::State& SimulatedBoard::truth() const noexcept { return rig_->mechanism.state(); }
std::int64_t SimulatedBoard::now_ns() const noexcept { return rig_->now_ns; }

}  // namespace crane::simulator
