#pragma once
/// Noise model of the error x of one output in a window (docs/diagnosis_method.md, 4):
///   x'' = -w^2 x - c x' + a + u,   a' = -a / correlation_s + white,   residual: x + noise
/// a: coloured acceleration. u: white acceleration at low speed, where the time of stick and slip cannot be
/// predicted. w = 0 for a drive, c = 0 for a pendulum. An axis that sticks loses the error of its speed at
/// turns and at rest.
#include <vector>

namespace crane::diagnosis {

struct Disturbance {
  double noise = 0;          ///< standard deviation of the sensor, m or rad
  double acceleration = 0;   ///< of a, m/s2 or rad/s2
  double correlation_s = 0;  ///< correlation time of a; 0: white
  double damping_ps = 0;     ///< c, 1/s
  double friction = 0;       ///< standard deviation of u at standstill, m/s2 or rad/s2
  bool sticks = false;
  double unit = 1;  ///< m or rad; the values above are multiples of it. Infinity: the speed has no error
  /// Minus twice the log likelihood of the residuals from which it was learnt, without constant.
  double misfit = 0;
};

/// Motion of the axis in a row. moving: the error of the speed persists. turning: the axis reverses or stops,
/// which ends the error of the speed. standing: at rest for several rows, without an error of the speed.
enum class MotionPhase { moving, turning, standing };

/// Motion of an axis in one row.
struct RowMotion {
  double slowness = 0;  ///< 0 at speed, 1 at standstill
  MotionPhase phase = MotionPhase::moving;
  bool measured = true;         ///< whether the row was measured
  bool speed_unknown = false;   ///< an edge of the command may have been lost: speed unknown
  double speed_inaccuracy = 0;  ///< PreparedRun::speed_inaccuracy
};
using MotionProfile = std::vector<RowMotion>;

/// Motion of one output in a window.
struct WindowMotion {
  double period_s = 0, natural_radps = 0;  ///< natural_radps: of a pendulum; 0: a drive
  MotionProfile profile;                   ///< by row
};

}  // namespace crane::diagnosis
