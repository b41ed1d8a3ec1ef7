#pragma once
/// Traffic of the bus: rates, losses and delays of every topic, and the status of every process. Delay and
/// jitter are measured from the latching of the encoders until the writer has sent the sample. The arrival
/// time in this process has no influence, because this process has no real-time priority.
#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "observation/arrival_statistics.hpp"
#include "observation/sample.hpp"

namespace crane::observation {

/// Upper bounds of the delay histogram, µs; one more bin counts longer delays.
inline constexpr std::array<double, 9> kDelayBounds_us{100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000};

struct TopicTraffic {
  ArrivalStatistics::Counts counts;
  ArrivalStatistics::Window window;
  /// From the latching of the encoders to the sending of the sample; nothing when writer and bridge are on
  /// different hosts.
  std::optional<Spread> delay_us;
  std::array<std::uint64_t, kDelayBounds_us.size() + 1> delay_histogram{};  ///< since the start
  crane_Source writer = crane_SOURCE_NONE;  ///< kind of process that wrote the newest sample
};

class Traffic {
 public:
  /// Interval over which rates and delays are computed.
  static constexpr std::int64_t kWindow_ns = 1'000'000'000;
  /// A process reports once a second. A process of the loop counts as silent after two missing reports. Twin
  /// and recorder have no real-time priority: a busy computer delays their reports by seconds.
  static constexpr std::int64_t kSilent_ns = 2'500'000'000, kSilentWithoutPriority_ns = 10'000'000'000;

  void add(const Sample& sample);
  /// Closes the window at its end. @return true when new figures are available
  bool poll(std::int64_t now_ns);

  struct NodeReport {
    msg::NodeStatus status{};
    std::int64_t arrival_ns = 0, log_time_ns = 0;
    std::int64_t source_time_ns = 0;  ///< clock of the writer
    /// Completed ticks per second between the last two reports; nothing before two reports of one start.
    std::optional<double> tick_rate_hz{};
    [[nodiscard]] bool silent(std::int64_t now_ns) const;
  };
  [[nodiscard]] const std::map<std::uint32_t, NodeReport>& nodes() const { return nodes_; }
  [[nodiscard]] const TopicTraffic& topic(std::size_t index) const { return topics_[index].figures; }
  [[nodiscard]] nlohmann::ordered_json json(std::int64_t now_ns) const;

 private:
  struct Line {
    explicit Line(bool every_tick) : statistics{every_tick} {}
    ArrivalStatistics statistics;
    std::vector<double> delays_us;  ///< of this window
    TopicTraffic figures;
  };
  std::vector<Line> topics_ = lines();
  static std::vector<Line> lines();
  void add_status(const Sample& sample, const msg::NodeStatus& status);
  std::map<std::uint32_t, NodeReport> nodes_;
  std::int64_t window_ends_ns_ = 0;
};

[[nodiscard]] const char* source_name(crane_Source source);
[[nodiscard]] const char* phase_name(crane_NodePhase phase);

}  // namespace crane::observation
