#pragma once
/// Content of `crane top`: traffic, state of the supervisor, faults, largest swing. No I/O; the time is an
/// argument.
#include <deque>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "observation/fault_timeline.hpp"
#include "observation/traffic.hpp"

namespace crane::cli {

class TopModel {
 public:
  static constexpr std::size_t kMostTrend = 30;  ///< windows of Traffic::kWindow_ns in a trend

  struct Swing {
    double angle_rad = 0;  ///< signed
    std::uint64_t tick = 0;
  };

  void add(const observation::SamplePtr& sample);
  /// @param log_now_ns  observation::log_now_ns(). @return true when new figures are available
  bool poll(std::int64_t now_ns, std::int64_t log_now_ns);
  /// True: crane/supervisor and crane/state have arrived, no topic appeared in the last window, and every
  /// visible process has reported twice.
  [[nodiscard]] bool complete() const;

  [[nodiscard]] const observation::Traffic& traffic() const { return traffic_; }
  [[nodiscard]] const observation::FaultTimeline& faults() const { return faults_; }
  [[nodiscard]] const std::optional<msg::SupervisorStatus>& supervisor() const { return supervisor_; }
  [[nodiscard]] const std::optional<msg::State>& state() const { return state_; }
  /// Age of the newest crane/supervisor or of the newest crane/state, whichever is older. A topic
  /// without a sample is not counted; 0 when neither topic has a sample.
  [[nodiscard]] std::int64_t age_ns(std::int64_t now_ns) const;
  /// Largest swings since the start.
  [[nodiscard]] const Swing& radial() const { return radial_; }
  [[nodiscard]] const Swing& tangential() const { return tangential_; }
  /// One value for each window, the newest last: p99 of the delay in us; without delay the rate in Hz.
  [[nodiscard]] const std::deque<double>& trend(std::size_t topic) const { return trends_[topic]; }

  /// {"supervisor": {"state", "cause", "remedy", "age_s"} or null, "latch", "tick", "largest_swing",
  /// "faults", "topics", "processes"}
  [[nodiscard]] nlohmann::ordered_json json(std::int64_t now_ns) const;

 private:
  observation::Traffic traffic_;
  observation::FaultTimeline faults_;
  observation::History no_history_{0};  ///< the terminal shows no data around a fault
  std::optional<msg::SupervisorStatus> supervisor_;
  std::optional<msg::State> state_;
  std::int64_t supervisor_ns_ = 0, state_ns_ = 0;  ///< monotonic arrival
  Swing radial_, tangential_;
  std::vector<std::deque<double>> trends_{topics::kAll.size()};
  std::size_t heard_topics_ = 0;  ///< at the end of the last window
  bool settled_ = false;          ///< true: no topic appeared in the last window
};

}  // namespace crane::cli
