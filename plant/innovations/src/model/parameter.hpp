#pragma once
/// The numbers that a hypothesis may free: those of the terms of plant/model in linear form, and those of the
/// noise. Values are kept in one array; null is no effect.
#include <array>
#include <string>
#include <vector>

#include "crane/innovations/data.hpp"
#include "crane/runtime/rig.hpp"

namespace crane::innovations {

/// Of one drive. Volts of its amplifier; speeds in m/s or rad/s.
enum AxisParameter : std::size_t {
  kCoulomb,       ///< V
  kViscous,       ///< V s/unit
  kAsymmetryDry,  ///< V, added for +v, taken off for -v
  kAsymmetryViscous,
  kStribeck,       ///< V
  kStribeckSpeed,  ///< unit/s
  kTight,          ///< V, of tight spots
  kTightAt,
  kTightWave,
  kRippleSine,  ///< V
  kRippleCosine,
  kRippleWave,
  kTurnSine,  ///< V, torque of one turn: gravity, spring, tilt
  kTurnCosine,
  kGain,  ///< factor - 1
  kOffset,
  kDeadZone,
  kDelay,
  kLag,
  kSecondLag,
  kLoadFriction,   ///< share of the torque that the gear carries
  kPositionScale,  ///< factor - 1
  kAxisParameters
};
/// Of the load and of the swing's sensors.
enum LoadParameter : std::size_t {
  kMass,
  kCable,
  kLinearDrag,
  kQuadraticDrag,
  kWindAlong,
  kWindAcross,
  kTilt,
  kLowerShare,
  kLowerLength,
  kHookRaised,
  kPivotViscous,                    ///< radial, then tangential
  kPivotDry = kPivotViscous + 2,    ///< likewise
  kSwingOffset = kPivotDry + 2,     ///< likewise
  kSwingScale = kSwingOffset + 2,   ///< likewise; factor - 1
  kMisalignment = kSwingScale + 2,  ///< rad
  kSwingDelay,
  kSwingAverage,
  kLoadParameters
};
/// Logarithms; of each coordinate: unknown force (V or N; m/s^2 where no command is known), its correlation
/// time, white noise of the sensor.
enum NoiseParameter : std::size_t { kLogForce, kLogCorrelation, kLogSensor, kNoiseParameters };

inline constexpr std::size_t kLoadBegin = 2 * kAxisParameters;
inline constexpr std::size_t kNoiseBegin = kLoadBegin + kLoadParameters;
/// Of each drive after the coordinates: standstill (m/s^1.5) and command noise (share of a step's area).
inline constexpr std::size_t kStandstillBegin = kNoiseBegin + kNoiseParameters * kChannels;
inline constexpr std::size_t kCommandNoiseBegin = kStandstillBegin + 2;
inline constexpr std::size_t kParameters = kCommandNoiseBegin + 2;

using Values = std::array<double, kParameters>;
using Index = std::size_t;

[[nodiscard]] constexpr Index of_axis(std::size_t drive, AxisParameter p) {
  return drive * kAxisParameters + p;
}
[[nodiscard]] constexpr Index of_load(std::size_t p) { return kLoadBegin + p; }
[[nodiscard]] constexpr Index of_noise(std::size_t channel, NoiseParameter p) {
  return kNoiseBegin + channel * kNoiseParameters + p;
}
[[nodiscard]] constexpr Index standstill_of(std::size_t drive) { return kStandstillBegin + drive; }
[[nodiscard]] constexpr Index command_noise_of(std::size_t drive) { return kCommandNoiseBegin + drive; }

/// How large things are in these data; all steps and bounds are multiples of these.
struct Scales {
  std::array<double, 2> volts{1, 1}, speed{1, 1}, travel{1, 1}, middle{0, 0};
  std::array<double, kChannels> floor{};  ///< least standard deviation of a sensor
  double load_n = 1;                      ///< weight
  double load_kg = 1, cable_m = 1, swing_rad = 1, omega_radps = 1;
};
[[nodiscard]] Scales scales_of(const runtime::Rig& rig, const std::vector<Run>& runs);

struct ParameterInfo {
  double null = 0, scale = 1, low = 0, high = 0;
};
using ParameterTable = std::array<ParameterInfo, kParameters>;
[[nodiscard]] ParameterTable parameter_table(const runtime::Rig& rig, const Scales& scales);
[[nodiscard]] Values null_values(const ParameterTable& table);

}  // namespace crane::innovations
