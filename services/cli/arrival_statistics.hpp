#pragma once
/// How regularly the samples of one topic come: rate and losses from the ticks and time stamps of the source,
/// which a burst on the way does not change; jitter and delay from the times of arrival.
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

namespace crane::cli {

struct Arrival {
  std::uint64_t tick = 0;
  std::uint32_t epoch = 0;  ///< start-up number of the writer; another one restarts the count of ticks
  std::int64_t source_time_ns = 0;   ///< when it was sampled, by the source's clock
  std::int64_t arrival_time_ns = 0;  ///< when it was taken, by this process's monotonic clock
};

/// Nearest-rank percentile of `values` (any order), `share` in [0, 1]; nothing for no values.
[[nodiscard]] std::optional<double> percentile(std::vector<double> values, double share);

struct Spread {
  double p50 = 0, p99 = 0, max = 0;
};
[[nodiscard]] std::optional<Spread> spread(const std::vector<double>& values);

class ArrivalStatistics {
 public:
  /// @param counts_ticks  every tick is due exactly once, so losses, duplicates and late ones can be told
  explicit ArrivalStatistics(bool counts_ticks) : counts_ticks_{counts_ticks} {}

  void add(const Arrival& arrival);

  struct Counts {
    std::uint64_t samples = 0;
    std::uint64_t lost = 0;       ///< ticks skipped that have not come since
    std::uint64_t late = 0;       ///< came after a younger one
    std::uint64_t duplicate = 0;  ///< tick that had come before
    std::uint64_t restarts = 0;   ///< a younger writer took over
  };
  /// Since the beginning.
  [[nodiscard]] Counts counts() const;

  struct Window {
    std::size_t samples = 0;
    std::optional<double> rate_hz;    ///< by the source's clock; nothing for fewer than two samples
    std::optional<Spread> jitter_us;  ///< |interval of arrival - interval at the source| of neighbours
  };
  /// Since the last call.
  Window take_window();

 private:
  void count(const Arrival& arrival);
  void skip(std::uint64_t from, std::uint64_t to);

  bool counts_ticks_;
  Counts counts_;
  std::optional<Arrival> newest_;
  std::set<std::uint64_t> missing_;
  std::optional<Arrival> window_first_, window_last_;
  std::size_t window_samples_ = 0, window_intervals_ = 0;
  std::vector<double> jitter_us_;
};

}  // namespace crane::cli
