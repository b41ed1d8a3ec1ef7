#pragma once
/// A tower crane in closed loop without bus, board and brakes: random moves, encoder counts and quantised
/// volts of a bridge. The plant can change during the motion.
#include <memory>
#include <optional>
#include <random>

#include "../plant/closed_loop.hpp"
#include "crane/bridge/converter.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/simulator/integrator.hpp"
#include "crane/twin/twin.hpp"

namespace crane::test {

/// Disturbances that no model contains: first-order coloured noise, correlation time 0.2 s.
struct Disturbance {
  double drive_v = 0;       ///< standard deviation of a force on trolley and slew, in volts of their drives
  double swing_radps2 = 0;  ///< of an acceleration of the swing
};

class SimulatedMotion {
 public:
  /// @param rig  parameters of the plant until a change, and of the controller
  SimulatedMotion(const configuration::Rig& rig, std::uint64_t seed, const Disturbance& disturbance = {})
      : rig_(rig), random_(seed), disturbance_(disturbance) {
    state_.trolley_m = 0.6;
    state_.cable_m = rig.start.position[plant::kHoist];
    become(rig.plant, rig.terms);
    choose_target();
  }

  /// Replaces the plant.
  void become(const plant::Parameters& parameters, const std::vector<plant::TermSetting>& terms) {
    integrator_.reset();
    model_ = std::make_unique<plant::Model>(parameters, terms, rig_.period_s);
    integrator_ = std::make_unique<simulator::Integrator>(*model_, simulator::Tolerances{1e-7, 1e-8});
  }
  void become_with(const plant::TermSetting& extra) {
    auto terms = rig_.terms;
    terms.push_back(extra);
    become(rig_.plant, terms);
  }
  /// The encoder jumps.
  void slip(std::size_t column, double by) {
    constexpr std::array<std::size_t, 4> kCounter{0, 1, 3, 4};
    const auto& encoder = rig_.encoders[kCounter[column]];
    slipped_[kCounter[column]] += std::llround(by * encoder.counts_per_unit);
  }
  void push(double radial_radps, double tangential_radps) {
    state_.radial_radps += radial_radps;
    state_.tangential_radps += tangential_radps;
  }

  /// Advances by one tick. @return its measurements
  twin::Sample next() {
    if (--until_move_ <= 0) choose_target();
    const plant::Measurement m = model_->measure(state_);
    twin::Sample sample;
    sample.tick = tick_++;
    sample.epoch = 1;
    const std::array<double, 5> coordinates{m.trolley_m, m.slew_rad, m.cable_m, m.radial_rad,
                                            m.tangential_rad};
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      sample.counts[i] =
          std::llround(rig_.encoders[i].sign * (coordinates[i] + rig_.encoders[i].rest_angle_rad) *
                       rig_.encoders[i].counts_per_unit) +
          slipped_[i];
    sample.rate = {state_.trolley_mps, state_.slew_radps, state_.radial_radps, state_.tangential_radps};
    sample.applied_v = command_v_;
    const plant::PerAxis applied = command_v_;
    const plant::PerAxis wanted = compensated(rig_.plant, seen(m), target_);
    for (std::size_t i = 0; i < plant::kAxes; ++i)
      command_v_[i] = bridge::converter_voltage_v(bridge::converter_code(wanted[i]));
    advance(applied);
    return sample;
  }
  [[nodiscard]] const plant::State& state() const { return state_; }

 private:
  [[nodiscard]] plant::State seen(const plant::Measurement& m) const {
    plant::State s = state_;
    s.trolley_m = m.trolley_m, s.slew_rad = m.slew_rad;
    s.radial_rad = m.radial_rad, s.tangential_rad = m.tangential_rad;
    return s;
  }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random_);
  }
  void choose_target() {
    target_.target_trolley_m = uniform(0.35, 1.15);
    target_.target_slew_rad = uniform(-1.5, 1.5);
    until_move_ = static_cast<int>(uniform(3, 8) / rig_.period_s);
  }
  void advance(const plant::PerAxis& applied) {
    constexpr double kCorrelation_s = 0.2;
    const double keep = std::exp(-rig_.period_s / kCorrelation_s), fresh = std::sqrt(1 - keep * keep);
    std::normal_distribution<double> normal;
    if (disturbance_.drive_v > 0 || disturbance_.swing_radps2 > 0)
      for (double& noise : noise_) noise = keep * noise + fresh * normal(random_);
    plant::Actuation actuation;
    actuation.drive_v = model_->drive_voltage(applied);
    actuation.drive_v[0] += disturbance_.drive_v * noise_[0];
    actuation.drive_v[1] += disturbance_.drive_v * noise_[1];
    state_.radial_radps += disturbance_.swing_radps2 * noise_[2] * rig_.period_s;
    state_.tangential_radps += disturbance_.swing_radps2 * noise_[3] * rig_.period_s;
    integrator_->advance(state_, actuation, rig_.period_s);
  }

  configuration::Rig rig_;
  std::mt19937_64 random_;
  Disturbance disturbance_;
  std::unique_ptr<plant::Model> model_;
  std::unique_ptr<simulator::Integrator> integrator_;
  plant::State state_;
  Maneuver target_;
  int until_move_ = 0;
  std::uint64_t tick_ = 0;
  plant::PerAxis command_v_{};
  std::array<double, 4> noise_{};
  std::array<std::int64_t, 5> slipped_{};
};

}  // namespace crane::test
