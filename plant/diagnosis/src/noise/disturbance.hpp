#pragma once
/// What sensor noise and an unknown force do to the residual of a window. The residual x of one output
/// follows
///   x'' = -w^2 x - c x' + a,   seen as x + noise,
/// with a an acceleration of first-order colour; w is 0 for a drive, c 0 for a pendulum. An axis that sticks
/// forgets the error of its speed; where it moves slowly, when exactly it breaks loose and comes to rest no
/// friction law knows: white acceleration there.
#include <vector>

namespace crane::diagnosis {

struct Disturbance {
  double noise = 0;          ///< standard deviation of the sensor, m or rad
  double acceleration = 0;   ///< of a, m/s2 or rad/s2
  double correlation_s = 0;  ///< correlation time of a; 0: white
  double damping_ps = 0;     ///< c, 1/s
  double friction = 0;       ///< standard deviation of the white acceleration at standstill, m/s2 or rad/s2
  bool sticks = false;
  double misfit =
      0;  ///< minus twice the log likelihood of the residuals it was learnt from, but for a constant
};

/// An axis that turns or comes to rest has forgotten what error its speed had; one that stands has none.
enum class MotionPhase { moving, turning, standing };

/// How an axis moved, by row of a window.
struct RowMotion {
  double slowness = 0;  ///< 0 at speed to 1 at standstill
  MotionPhase phase = MotionPhase::moving;
  bool seen = true;            ///< whether the row was measured
  bool speed_unknown = false;  ///< whether an unknown command may have changed the speed in the row
};
using MotionProfile = std::vector<RowMotion>;

/// A window of one output: how long, how it moved.
struct WindowMotion {
  double period_s = 0, natural_radps = 0;  ///< natural: of a pendulum; 0: a drive
  MotionProfile profile;                   ///< by row
};

}  // namespace crane::diagnosis
