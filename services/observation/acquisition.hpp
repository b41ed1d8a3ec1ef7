#pragma once
/// Captures of an oscilloscope: the rows around the tick at which a condition becomes true. Pure.
#include <deque>
#include <optional>
#include <vector>

#include "observation/tick_rows.hpp"

namespace crane::observation {

struct Capture {
  std::vector<Row> rows;
  std::optional<std::size_t> trigger;  ///< index in `rows`; nothing: captured without a trigger (automatic)
  bool complete = true;                ///< false: the data ended before the end of the window
};

class Acquisition {
 public:
  /// Rows that one capture holds at most: 1000 s at 100 Hz. Longer windows lose their oldest rows.
  static constexpr std::size_t kMostRows = 100'000;

  struct Window {
    std::int64_t before_ns = 1'000'000'000;  ///< >= 0
    std::int64_t after_ns = 2'000'000'000;   ///< >= 0
    bool automatic = false;  ///< true: captures also when no trigger comes for before_ns + after_ns
  };
  explicit Acquisition(const Window& window) : window_{window} {}

  /// The trigger is the row in which the condition becomes true: 1 after a 0. Unknown (NaN) changes nothing.
  /// Triggers within a capture are ignored. @param condition  1, 0 or NaN. @return a capture that ends with
  /// this row
  std::optional<Capture> add(const Row& row, double condition);
  /// The end of the data. @return the capture whose window is not over; nothing: none has begun
  std::optional<Capture> finish();

  [[nodiscard]] bool triggered() const { return trigger_tick_.has_value(); }  ///< a capture has begun
  [[nodiscard]] std::uint64_t rows() const { return rows_; }                  ///< since the start

 private:
  void drop_old(std::int64_t now_ns);
  Capture take(bool complete);

  Window window_;
  std::deque<Row> ring_;
  std::optional<double> condition_;  ///< last known
  std::optional<std::uint64_t> trigger_tick_;
  std::int64_t trigger_ns_ = 0;
  std::optional<std::int64_t> armed_ns_;  ///< begin of the wait for a trigger
  std::uint64_t rows_ = 0;
};

}  // namespace crane::observation
