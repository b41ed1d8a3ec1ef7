#pragma once
/// From raw counts to positions, swing angles, speeds and rates (dissertation section 4.3). The same for
/// every board: nothing here knows whether a plant or a simulation made the counts.
#include <array>
#include <cstdint>

#include "crane/bridge/board.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/control/filters.hpp"
#include "crane/control/law.hpp"

namespace crane::bridge {

/// A 24-bit counter continued beyond its range: successive readings differ by less than 2^23 counts.
class CountUnwrapper {
 public:
  [[nodiscard]] std::int64_t step(std::int32_t raw_counts) noexcept;

 private:
  std::int64_t counts_ = 0;
  bool started_ = false;
};

/// Where a sample lies on the grid of ticks.
struct Latched {
  std::uint64_t ticks = 1;  ///< since the sample before, >= 1
  double late_s = 0;        ///< after the time of its tick, >= 0
};

/// Position and its rate from one encoder. The filters want samples that are a period apart: a sample that
/// was latched late is moved back to the time of its tick by the present rate, and ticks that were skipped
/// are filled in between the sample before and this one. The position itself is that of the sample.
class Coordinate {
 public:
  /// @param cut_off_ratio   of the low-pass in front of the differentiator; 0: none
  /// @param filter_position the position passed on is behind the low-pass, too
  Coordinate(const configuration::Encoder& encoder, double period_s, double cut_off_ratio,
             bool filter_position = false);
  void step(std::int32_t raw_counts, const Latched& latched = {}) noexcept;
  /// The same place is `change` counts farther from now on; the axis rests there.
  void shift(std::int64_t change) noexcept;
  [[nodiscard]] std::int64_t counts() const { return counts_; }
  [[nodiscard]] double position() const { return position_; }  ///< m or rad
  [[nodiscard]] double rate() const { return rate_; }          ///< per second

 private:
  void filter(double position) noexcept;

  CountUnwrapper unwrapper_;
  double units_per_count_;
  bool filter_position_;
  control::FilterSection low_pass_;
  control::FilterSection differentiator_;
  control::FilterMemory low_pass_memory_, differentiator_memory_;
  bool started_ = false;
  std::int64_t shift_ = 0;
  std::int64_t counts_ = 0;
  double position_ = 0, rate_ = 0;
  double smooth_ = 0;   ///< behind the low-pass
  double gridded_ = 0;  ///< position at the time of the last tick
};

class MeasurementPipeline {
 public:
  explicit MeasurementPipeline(const configuration::Rig& rig);
  /// One tick. @return positions, speeds, swing angles and rates in SI units
  control::Measurement step(const std::array<std::int32_t, kCounters>& raw_counts,
                            const Latched& latched = {}) noexcept;
  [[nodiscard]] const std::array<Coordinate, kCounters>& coordinates() const { return coordinates_; }
  /// See Coordinate; acts from the next step on.
  void shift(std::size_t counter, std::int64_t change) noexcept { coordinates_[counter].shift(change); }

 private:
  std::array<Coordinate, kCounters> coordinates_;
};

}  // namespace crane::bridge
