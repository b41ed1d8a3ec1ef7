#pragma once
// The simulated crane with the step of the real supervisor, without a bus. The test demands any voltage.
#include <cmath>
#include <cstdlib>
#include <optional>

#include "crane/configuration/rig.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/simulator/component.hpp"
#include "crane/simulator/simulated_board.hpp"
#include "crane/supervisor/component.hpp"
#include "crane/supervisor/supervisor.hpp"

namespace crane::zones_test {

using supervisor::PerAxis;

inline configuration::Rig deployed_rig(const std::string& name) {
  return configuration::load_rig(std::string{CRANE_RIGS} + "/" + name + ".toml");
}

/// Value of an environment variable that gives a number of runs or a seed.
inline std::uint64_t number(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): one thread
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

class GuardedCrane {
 public:
  /// @param truth  the simulated crane; @param nominal  the rig file of the supervisor
  GuardedCrane(const configuration::Rig& truth, const configuration::Rig& nominal)
      : limits{supervisor::limits_of(nominal)}, rig_{nominal}, board_{fast(truth)} {
    memory.machine.state = supervisor::State::ready;
    memory.machine.self_test_passed = true;
    input.self_test = supervisor::SelfTest::passed;
    input.reference_moving = true;
    for (int i = 0; i < 30; ++i) tick({});
    memory.machine.state = supervisor::State::arming;
    memory.machine.releasing = true;
    memory.machine.release_since_s = input.now_s;
    memory.release_position = memory.motion.position;
    for (int i = 0; i < 15 && memory.machine.state == supervisor::State::arming; ++i) tick({});
  }

  supervisor::Limits limits;
  supervisor::TickMemory memory;
  supervisor::TickInput input;
  supervisor::TickOutput out;
  bool demand_arrives = true, state_arrives = true;

  /// Runs one tick. The voltage acts from the next tick on.
  void tick(const PerAxis& demand_v) {
    ++tick_;
    const auto time_ns =
        static_cast<std::int64_t>(std::llround(static_cast<double>(tick_) * rig_.period_s * 1e9));
    board_.advance_to(time_ns);
    sample(board_.read(), board_.write(outputs_));
    input.now_s = input.sample.time_s = static_cast<double>(time_ns) / 1e9;
    input.tick = tick_;
    input.state_arrived = state_arrives;
    input.demand_arrived = demand_arrives;
    input.demand_v = demand_v;
    out = supervisor::step(limits, input, memory);
    outputs_ = {.drive_v = out.drive_v,
                .brake_release = out.brake_release,
                .watchdog_level = out.watchdog_permission && !outputs_.watchdog_level};
  }
  void press_estop(bool pressed) { board_.press_estop(pressed); }

  [[nodiscard]] supervisor::State state() const { return out.state; }
  [[nodiscard]] supervisor::Cause cause() const { return out.cause; }
  [[nodiscard]] bool armed() const { return memory.machine.releasing; }
  [[nodiscard]] const plant::State& truth() const { return board_.truth(); }
  [[nodiscard]] double speed(std::size_t axis) const { return memory.motion.speed[axis]; }

 private:
  static simulator::SimulatedRig fast(const configuration::Rig& rig) {
    auto simulated = simulator::simulated_rig_of(rig);
    simulated.integrator = simulator::Method::fast;
    return simulated;
  }
  void sample(const bridge::Inputs& in, const std::array<double, bridge::kDrives>& applied_v) {
    const auto measured = [&](std::size_t i) {
      const auto& encoder = rig_.encoders[i];
      return encoder.counts_per_unit > 0 ? encoder.sign * in.raw_counts[i] / encoder.counts_per_unit : 0;
    };
    auto& s = input.sample;
    for (std::size_t i = 0; i < plant::kAxes; ++i) {
      s.position[i] = measured(i);
      s.brake_closed[i] = in.brake_closed[i];
      s.limit_low[i] = in.limit_low[i];
      s.limit_high[i] = in.limit_high[i];
      s.applied_v[i] = applied_v[i];
    }
    s.swing_radial_rad = measured(plant::kSwingRadial);
    s.swing_tangential_rad = measured(plant::kSwingTangential);
    s.estop_pressed = in.estop_pressed;
    s.watchdog_dropped = in.watchdog_dropped;
  }

  configuration::Rig rig_;
  simulator::SimulatedBoard board_;
  bridge::Outputs outputs_{};
  std::uint64_t tick_ = 0;
};

/// Positions in coordinates of the ground, computed from (2.11) without the code of the filter.
using Point = std::array<double, 3>;
inline Point on_cable(const plant::State& s, double share, double suspension_height_m) {
  const double along = s.trolley_m - share * s.cable_m * std::cos(s.tangential_rad) * std::sin(s.radial_rad);
  const double across = share * s.cable_m * std::sin(s.tangential_rad);
  const double depth = share * s.cable_m * std::cos(s.tangential_rad) * std::cos(s.radial_rad);
  return {along * std::cos(s.slew_rad) - across * std::sin(s.slew_rad),
          along * std::sin(s.slew_rad) + across * std::cos(s.slew_rad), suspension_height_m - depth};
}

/// Distance of a point from the solid, 0 inside.
inline double distance_m(const control::Zone& zone, const Point& point) {
  const auto outside = [](double value, double low, double high) {
    return value < low ? low - value : value > high ? value - high : 0;
  };
  const double height = outside(point[2], zone.bottom_m, zone.top_m);
  if (zone.shape == control::ZoneShape::cylinder) {
    const double radius =
        std::sqrt(std::pow(point[0] - zone.position_x_m, 2) + std::pow(point[1] - zone.position_y_m, 2));
    return std::sqrt(std::pow(std::max(0.0, radius - zone.radius_m), 2) + height * height);
  }
  const double x =
      outside(point[0], zone.position_x_m - zone.size_x_m / 2, zone.position_x_m + zone.size_x_m / 2);
  const double y =
      outside(point[1], zone.position_y_m - zone.size_y_m / 2, zone.position_y_m + zone.size_y_m / 2);
  return std::sqrt(x * x + y * y + height * height);
}

/// Distance of load (a sphere) and cable (ten points) from all zones; negative: the load is inside one.
inline double gap_m(const std::vector<control::Zone>& zones, const control::Clearance& clearance,
                    const plant::State& state) {
  double gap = std::numeric_limits<double>::infinity();
  for (const auto& zone : zones)
    for (int i = 1; i <= 10; ++i) {
      const double to_point = distance_m(zone, on_cable(state, i / 10.0, clearance.suspension_height_m));
      gap = std::min(gap, i == 10 ? to_point - clearance.load_radius_m : to_point);
    }
  return gap;
}
/// The same from a sample of crane/state.
inline double gap_m(const configuration::Rig& rig, const msg::State& s) {
  return gap_m(rig.zones, rig.clearance,
               {.trolley_m = s.trolley_position_m,
                .radial_rad = s.swing_radial_rad,
                .slew_rad = s.slew_angle_rad,
                .tangential_rad = s.swing_tangential_rad,
                .cable_m = s.cable_length_m});
}

}  // namespace crane::zones_test
