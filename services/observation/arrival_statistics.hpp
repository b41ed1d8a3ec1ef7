#pragma once
/// Statistics of the samples of one topic. Rate and losses are computed from ticks and time stamps of the
/// source, so that bursts in the transport have no influence. Jitter and delay are computed from the arrival
/// times.
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

namespace crane::observation {

struct Arrival {
  std::uint64_t tick = 0;
  std::uint32_t epoch = 0;  ///< start-up number of the writer; a new number restarts the count of ticks
  std::int64_t source_time_ns = 0;   ///< sample time, clock of the source
  std::int64_t arrival_time_ns = 0;  ///< arrival time, monotonic clock of this process
};

/// Nearest-rank percentile of `values` (any order); nothing without values. @param share  in [0, 1]
[[nodiscard]] std::optional<double> percentile(std::vector<double> values, double share);

struct Spread {
  double p50 = 0, p99 = 0, max = 0;
};
[[nodiscard]] std::optional<Spread> spread(const std::vector<double>& values);

/// Detects the end of the initial burst of samples. A reliable writer keeps unacknowledged samples, at most
/// its history of 128, and sends them to a new reader together. The arrival times of this burst must not
/// count as jitter.
class Joining {
 public:
  /// Call for each sample in the order of the source. @return true after the burst: from the first arrival
  /// interval on that is at least half the source interval, at the latest after kLongest_ns of source time
  bool over(std::int64_t source_time_ns, std::int64_t arrival_time_ns);

 private:
  static constexpr std::int64_t kLongest_ns = 2'000'000'000;  ///< longer than 128 samples at 100 Hz
  struct Times {
    std::int64_t source_ns, arrival_ns;
  };
  std::optional<Times> first_, last_;
  bool over_ = false;
};

class ArrivalStatistics {
 public:
  /// @param counts_ticks  true: every tick has one sample, so that lost, duplicate and late samples can be
  ///   counted
  explicit ArrivalStatistics(bool counts_ticks) : counts_ticks_{counts_ticks} {}

  void add(const Arrival& arrival);

  struct Counts {
    std::uint64_t samples = 0;
    std::uint64_t lost = 0;       ///< ticks without a sample
    std::uint64_t late = 0;       ///< samples that arrived after a sample of a later tick
    std::uint64_t duplicate = 0;  ///< second samples of a tick
    std::uint64_t restarts = 0;   ///< changes of the start-up number
  };
  /// Counts since the beginning.
  [[nodiscard]] Counts counts() const;

  struct Window {
    std::size_t samples = 0;
    std::optional<double> rate_hz;    ///< by the clock of the source; nothing for fewer than two samples
    std::optional<Spread> jitter_us;  ///< |arrival interval - source interval| of consecutive samples
  };
  /// Statistics since the last call.
  Window take_window();

 private:
  void count(const Arrival& arrival);
  void skip(std::uint64_t from, std::uint64_t to);

  bool counts_ticks_;
  Counts counts_;
  std::optional<Arrival> newest_;
  std::set<std::uint64_t> missing_;
  std::optional<Arrival> window_first_, window_last_;
  Joining joining_;
  std::size_t window_samples_ = 0, window_intervals_ = 0;
  std::vector<double> jitter_us_;
};

}  // namespace crane::observation
