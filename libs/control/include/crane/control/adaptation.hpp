#pragma once
/// Online adaptation: estimates the friction of trolley and slew axis, the payload, the length of the
/// pendulum and the swing offset while the crane moves, and sets the levels of the friction compensation. The
/// caller calls step() once per tick. No allocation, no exception, no clock. Equations and thresholds:
/// docs/adaptation.md.
#include <cstdint>
#include <memory>

#include "crane/control/law.hpp"

namespace crane::control {

inline constexpr std::size_t kAdaptedAxes = 2;  ///< trolley, slew; the hoist drive is speed-controlled

/// Friction of one direction of motion.
struct FrictionLevels {
  double coulomb_v = 0;
  double viscous_vspm = 0;  ///< V per m/s or V per rad/s
  double static_v = 0;      ///< break-away level

  bool operator==(const FrictionLevels&) const = default;
};

/// Meanings and order of the enumerators are those of crane.idl.
enum class AdaptationPhase : std::uint8_t { off, frozen, learning };
enum class AdaptationFreeze : std::uint8_t {
  none,
  limit_cycle,
  rolled_back,
  gap,
  brake,
  not_executed,
  saturation,
  swing,
  hoist,
  standstill,
  implausible
};

/// One direction of motion, since the start.
struct DirectionReport {
  FrictionLevels estimate, std_dev;           ///< std_dev: standard deviations of the estimates
  FrictionLevels used;                        ///< levels of the compensation, before its factor
  std::uint32_t blocks = 0, break_aways = 0;  ///< accepted blocks (docs/adaptation.md#force-balance)
};

struct AxisReport {
  AdaptationPhase phase = AdaptationPhase::off;
  AdaptationFreeze freeze = AdaptationFreeze::none;
  std::array<DirectionReport, 2> direction;  ///< positive, negative
  /// unexplained voltage of the last block, and its standard deviation
  double innovation_v = 0, innovation_std_v = 0;
  /// rms voltage of the last judged move that the levels in use and the previous levels leave unexplained
  double move_residual_v = 0, previous_residual_v = 0;
  double confidence = 0;  ///< accuracy of the Coulomb levels; 0: that of the rig file, 1: exact
  std::uint32_t installed = 0, roll_backs = 0, limit_cycles = 0, refused_blocks = 0;  ///< since the start
};

/// A value with its standard deviation.
struct Estimated {
  double value = 0, std_dev = 0;
};

struct AdaptationReport {
  std::array<AxisReport, kAdaptedAxes> axis;
  Estimated load_mass_kg, pendulum_length_m;
  std::array<Estimated, 2> swing_offset_rad;  ///< radial, tangential
  std::uint32_t moves = 0;
};

/// Measurement of one tick, and the demand of the previous tick, whose command acts from this tick on.
struct AdaptationInput {
  Measurement measured;
  Volts demand_v{};                        ///< demand of the previous tick
  std::array<bool, kAxes> brake_closed{};  ///< true: the brake holds the axis
  bool consecutive = false;                ///< true: the previous tick was processed, and its command acts
};

class Adaptation {
 public:
  /// Allocates the memory. @pre problems(design).empty()
  explicit Adaptation(const Design& design);
  ~Adaptation();
  Adaptation(Adaptation&&) noexcept;
  Adaptation& operator=(Adaptation&&) noexcept;

  void step(const AdaptationInput& input) noexcept;
  /// Friction that the compensation uses from this tick on. An axis that does not adapt has the friction of
  /// the design.
  [[nodiscard]] const std::array<DriveFriction, kAxes>& friction() const noexcept;
  [[nodiscard]] const AdaptationReport& report() const noexcept;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace crane::control
