#pragma once
/// Converts raw counts to positions, swing angles, speeds and rates, for every board.
/// Source of the filters: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003, section 4.3.
#include <array>
#include <cstdint>

#include "crane/bridge/board.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/control/filters.hpp"
#include "crane/control/law.hpp"

namespace crane::bridge {

/// Extends a 24-bit counter beyond its range. @pre two successive readings differ by less than 2^23 counts,
/// and so do the start and the first reading
class CountUnwrapper {
 public:
  /// @param start  expected count. step() first returns the value nearest to `start` that is equal
  ///   to the reading modulo 2^24
  explicit CountUnwrapper(std::int64_t start = 0) : counts_{start} {}
  [[nodiscard]] std::int64_t step(std::int32_t raw_counts) noexcept;

 private:
  std::int64_t counts_;
};

/// Time of a sample relative to the nominal ticks.
struct Latched {
  std::uint64_t ticks = 1;  ///< ticks since the previous sample, >= 1
  double late_s = 0;        ///< delay after the nominal time of the tick, >= 0
};

/// Position and rate from one encoder. The filters require samples at the nominal ticks. Therefore the input
/// of the filters is extrapolated from a late sample to the time of its tick with the present rate, and
/// skipped ticks are interpolated. Without filter_position, position() is the position of the sample itself.
class Coordinate {
 public:
  /// @param cutoff_ratio     cut-off / sampling frequency of the low-pass filter; 0: no filter
  /// @param filter_position  true: position() is also low-pass filtered
  /// @param start            expected counts of the first step
  Coordinate(const configuration::Encoder& encoder, double period_s, double cutoff_ratio,
             bool filter_position = false, std::int64_t start = 0);
  void step(std::int32_t raw_counts, const Latched& latched = {}) noexcept;
  /// Adds `change` to the counter. @pre the axis is at rest
  void shift(std::int64_t change) noexcept;
  [[nodiscard]] std::int64_t counts() const { return counts_; }
  [[nodiscard]] double position() const { return position_; }  ///< m or rad
  [[nodiscard]] double rate() const { return rate_; }          ///< per second

 private:
  void filter(double position) noexcept;

  CountUnwrapper unwrapper_;
  double units_per_count_;
  double rest_;  ///< swing encoders: angle of the load at rest, rad
  bool filter_position_;
  control::FilterSection low_pass_;
  control::FilterSection differentiator_;
  control::FilterMemory low_pass_memory_, differentiator_memory_;
  bool started_ = false;
  std::int64_t shift_ = 0;
  std::int64_t counts_ = 0;
  double position_ = 0, rate_ = 0;
  double smooth_ = 0;   ///< output of the low-pass filter
  double gridded_ = 0;  ///< position extrapolated to the nominal time of the last tick
};

class MeasurementPipeline {
 public:
  explicit MeasurementPipeline(const configuration::Rig& rig);
  /// Processes the counts of one tick. @return positions, speeds, swing angles and rates in SI units
  control::Measurement step(const std::array<std::int32_t, kCounters>& raw_counts,
                            const Latched& latched = {}) noexcept;
  [[nodiscard]] const std::array<Coordinate, kCounters>& coordinates() const { return coordinates_; }
  /// Calls Coordinate::shift(); the shift acts from the next step on.
  void shift(std::size_t counter, std::int64_t change) noexcept { coordinates_[counter].shift(change); }

 private:
  MeasurementPipeline(const configuration::Rig& rig, const std::array<std::int64_t, kCounters>& start);

  std::array<Coordinate, kCounters> coordinates_;
};

}  // namespace crane::bridge
