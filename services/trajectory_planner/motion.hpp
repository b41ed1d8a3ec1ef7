#pragma once
/// The planner's memory without the bus: what is being followed and since when.
#include <array>
#include <cstdint>
#include <optional>

#include "crane/configuration/rig.hpp"
#include "crane/control/excitation.hpp"
#include "crane/control/law.hpp"
#include "crane/control/shaper.hpp"
#include "crane/control/trajectory.hpp"

namespace crane::services {

/// What a move asks for. Axes that are not selected stay where their reference is.
struct MoveTarget {
  std::array<bool, control::kAxes> selected{};
  std::array<double, control::kAxes> target{};  ///< m, rad, m of cable
};

class Motion {
 public:
  /// @param rig  limits of the reference per drive; must outlive the motion
  Motion(const configuration::Rig& rig, control::ReferenceShape shape) : rig_{rig}, shape_{shape} {}

  /// Rest at what is measured: the crane is not under control.
  void follow(const control::Measurement& measured, std::uint64_t tick) noexcept;
  /// Begin a move at `tick` from the present reference.
  void start(const MoveTarget& move, std::uint64_t tick);
  /// Excite one axis from `tick` on; the others stay where their reference is.
  void excite(const control::Excitation& excitation, std::uint64_t tick);
  /// Come to rest from the measured speed at the reference acceleration.
  void stop(const control::Measurement& measured, std::uint64_t tick) noexcept;
  /// Move at constant speeds, per second; 0: stay. A new speed begins where the axis is, so that a mark that
  /// is seen is not passed by the way that the axis lags behind.
  void creep(const std::array<double, control::kAxes>& speed, const control::Measurement& measured,
             std::uint64_t tick) noexcept;
  /// Reference at `tick`.
  [[nodiscard]] control::Reference at(std::uint64_t tick) const noexcept;
  /// The reference has ended and the crane rests on it.
  [[nodiscard]] bool arrived(const control::Measurement& measured, std::uint64_t tick) const noexcept;

 private:
  /// Braking from a speed to rest at constant deceleration; a profile at rest where `speed` is 0.
  struct Braking {
    double start = 0, speed = 0, deceleration = 1;
    [[nodiscard]] control::AxisReference at(double time_s) const noexcept;
  };
  struct Creeping {
    std::array<double, control::kAxes> speed{}, start{};
  };
  [[nodiscard]] control::AxisProfile planned(std::size_t axis, double start, double target) const;
  [[nodiscard]] control::Shaper shaper() const;
  [[nodiscard]] double time_s(std::uint64_t tick) const noexcept;

  const configuration::Rig& rig_;
  control::ReferenceShape shape_;
  control::Trajectory trajectory_{};
  control::Shaper shaper_;  ///< of trolley and slew; the hoist makes no swing
  std::array<Braking, control::kAxes> braking_{};
  std::optional<control::Excitation> excitation_;  ///< takes the place of its axis' profile
  std::optional<Creeping> creeping_;
  bool is_braking_ = false;
  std::uint64_t start_tick_ = 0;
};

}  // namespace crane::services
