#pragma once
/// Captures the rows around a trigger, like an oscilloscope. The trigger is the row in which a condition
/// becomes true. No I/O and no clock.
#include <deque>
#include <optional>
#include <vector>

#include "observation/tick_rows.hpp"

namespace crane::observation {

struct Capture {
  std::vector<Row> rows;
  std::optional<std::size_t> trigger;  ///< index in `rows`; nothing: an automatic capture without a trigger
  bool complete = true;                ///< false: the data ended before the end of the window
};

class Acquisition {
 public:
  /// Largest number of rows of a capture: 1000 s at 100 Hz. A capture of a longer window lacks its oldest
  /// rows.
  static constexpr std::size_t kMostRows = 100'000;

  struct Window {
    std::int64_t before_ns = 1'000'000'000;  ///< >= 0
    std::int64_t after_ns = 2'000'000'000;   ///< >= 0
    bool automatic = false;  ///< true: also captures when before_ns + after_ns pass without a trigger
  };
  explicit Acquisition(const Window& window) : window_{window} {}

  /// Adds a row. A row is a trigger when its condition is 1 and the last known condition was 0. Triggers
  /// within a capture have no effect.
  /// @param condition  1, 0, or NaN: unknown
  /// @return the capture that ends with this row; nothing: no capture ends with this row
  std::optional<Capture> add(const Row& row, double condition);
  /// Call at the end of the data. @return the unfinished capture; nothing: there is none
  std::optional<Capture> finish();

  [[nodiscard]] bool triggered() const { return trigger_tick_.has_value(); }  ///< true: a capture has begun
  [[nodiscard]] std::uint64_t rows() const { return rows_; }                  ///< number of rows added

 private:
  void drop_old(std::int64_t now_ns);
  Capture take(bool complete);

  Window window_;
  std::deque<Row> ring_;
  std::optional<double> condition_;  ///< last known
  std::optional<std::uint64_t> trigger_tick_;
  std::int64_t trigger_ns_ = 0;
  std::optional<std::int64_t> armed_ns_;  ///< time at which the wait for a trigger began
  std::uint64_t rows_ = 0;
};

}  // namespace crane::observation
