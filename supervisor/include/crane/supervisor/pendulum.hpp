#pragma once
/// Check of the swing encoders: compares the measured motion of the load with that of a pendulum
/// whose suspension point is the measured trolley. Coordinates of the ground; equation numbers of
/// H. M. Omar, Control of Gantry and Tower Cranes:
///   r'' = -(g + z'') (r - p) / h                                                     (2.11), (2.18), (2.19)
/// r and p: horizontal positions of load and trolley, z = -h: height of the load relative to the jib. All
/// three are measured. Therefore the balance of one sample
///   e = change of r' + (g + z'') (r - p) / h dt
/// does not depend on drives, friction or load mass. The mean of e over kMeanSamples samples is
/// added to a vector sum (run_length.hpp); in each sample, the tolerances reduce the sum. The
/// tolerances for the zero error kZeroError_rad, the wind of the rig file (Limits::clearance) and
/// the damping ratio kDampingRatio apply in every direction. A cable k times as long as measured
/// causes e = (1 - k) dr'. Therefore the tolerance kCableTolerance times the change of the swing
/// rate dr' applies only along dr'. When the sum exceeds kPermittedSum_mps plus the quantisation of
/// the speeds of load and trolley, a swing encoder or the encoder of the axis that carries the load has
/// failed. The samples of the check are so far apart that the quantisation of the depth hides z'' by at most
/// 0.3 g: 10 ms with a cable of 1 m, 0.08 s with 80 m.
///
/// Push: a pushed load gains its speed within one or two samples and swings as a pendulum
/// afterwards. A sum above the limit counts as a push, and is cleared, if (a) the sum has grown for at
/// most kPush_samples and (b) at least half of the sum is a change of the swing rate in the direction of
/// the sum. One push per kPushInterval_s is permitted. If a swing encoder that counted before the push
/// then stands still for kNoCount_samples, the encoder has failed, because no push stops a load exactly.
///
/// If crane/state contains filtered swing angles, the check filters the positions in the same way: the
/// balance then holds for the filtered motion. After the first sample, and after a gap of more than 0.1 s,
/// the check waits until its filter has settled.
///
/// Detection time of a frozen swing encoder with the error a, rad:
///   (kPermittedSum_mps + noise) / (g (|a| - kZeroError_rad) - wind) + (kMeanSamples + 2) samples.
/// An error below kZeroError_rad + wind / g is not detected: 46 mrad with the default wind of 0.25 m/s2.
/// False alarms: none within the tolerances; for an additional white disturbance whose rms per
/// sample is pendulum_drift(), the average run length is above 1e9 ticks
/// (tests/supervisor/model_checks_test.cpp).
#include "crane/control/cable_tolerance.hpp"
#include "crane/supervisor/limits.hpp"

namespace crane::supervisor {

using control::kCableTolerance;

/// samples of the mean; it divides the quantisation of the swing rate by 4
inline constexpr std::size_t kMeanSamples = 4;
inline constexpr double kZeroError_rad = 0.02;     ///< zero error of a swing encoder
inline constexpr double kDampingRatio = 0.05;      ///< damping ratio of air, bearing and cable
inline constexpr double kPermittedSum_mps = 0.05;  ///< permitted sum without quantisation
inline constexpr int kPush_samples = 6;            ///< kMeanSamples, and the two samples of a speed
inline constexpr double kPushInterval_s = 0.5;     ///< shortest time between two pushes
/// at 0.3 rad/s, an encoder with 3820 counts per rad changes by 90 counts in this time
inline constexpr int kNoCount_samples = 8;

struct PendulumInput {
  double sampled_s = 0;
  PerAxis position{};
  double radial_rad = 0, tangential_rad = 0;
};

struct PendulumMemory {
  using Plane = std::array<double, 2>;
  /// One sample of the last three, newest first, in coordinates of the ground.
  struct PastSample {
    double sampled_s = 0;
    Plane pivot_m{}, load_offset_m{};  ///< horizontal: trolley, and load relative to the trolley
    double depth_m = 1;                ///< depth of the load below the jib
  };
  struct Balance {
    Plane error_mps{}, swing_change_mps{};  ///< e, and the change of the swing rate times the cable length
  };
  std::array<PastSample, 3> recent{};
  std::size_t samples = 0;  ///< number of samples since the start, at most kMeanSamples + 2
  std::array<control::FilterMemory, kAxes> filter{};  ///< of the positions, if the angles are filtered
  bool filter_started = false;
  PerAxis unfiltered_position{};  ///< of the newest sample
  int filter_ticks_left = 0;      ///< ticks until the filter of the positions has settled; > 0: the sum is 0
  std::array<Balance, kMeanSamples> balances{};
  std::size_t next = 0;  ///< index of the next balance
  Plane sum_mps{};
  Plane swing_change_mps{};           ///< change of the swing speed within the last kMeanSamples samples
  int growing_samples = 0;            ///< consecutive samples with a sum above 0, at most kPush_samples + 1
  double push_left_s = 0;             ///< time until another push is permitted; <= 0: at once
  std::array<double, 2> swing_rad{};  ///< newest, radial and tangential
  std::array<int, 2>
      counting_samples{};  ///< > 0: the encoder has counted within the last 2 kPush_samples samples
  std::array<int, 2> no_count_samples{};  ///< consecutive samples without a count after a push
  std::array<bool, 2> counted_before_push{};
  double largest = 0;  ///< largest sum / limit so far; above 1 is a failure
};

/// Change of speed in one sample that zero error and wind permit, m/s; each sample reduces the sum
/// by it.
[[nodiscard]] double pendulum_drift(const Limits& limits, double span_s) noexcept;

/// Processes one sample. @return true when a swing encoder has failed; never while `limits.machine.known` is
/// false
[[nodiscard]] bool swing_sensor_failed(const Limits& limits, const PendulumInput& input,
                                       PendulumMemory& memory) noexcept;

}  // namespace crane::supervisor
