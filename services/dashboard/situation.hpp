#pragma once
/// State of the crane, its cause and remedy, and the supervisor's answer to each possible request.
#include <deque>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "observation/sample.hpp"

namespace crane::dashboard {

class Situation {
 public:
  void add(const observation::Sample& sample);
  /// JSON of the situation. Two texts differ only when information for the operator differs.
  [[nodiscard]] nlohmann::ordered_json json(std::int64_t now_ns) const;

  /// @param id  "EPOCH-TICK" of a crane/supervisor: a tick alone would also name a tick of another run
  /// @return its header; nothing when it has not arrived within runtime::kRequestLife_ns
  [[nodiscard]] std::optional<msg::Header> status_of(std::string_view id, std::int64_t now_ns) const;
  /// @return true when a crane/supervisor has arrived within observation::kStale_ns
  [[nodiscard]] bool hears_supervisor(std::int64_t now_ns) const {
    return supervisor_ && now_ns - supervisor_ns_ <= observation::kStale_ns;
  }

  /// @return crane/state that has arrived within `age_ns`; nullptr: none
  [[nodiscard]] const msg::State* state_within(std::int64_t age_ns, std::int64_t now_ns) const {
    return state_ && now_ns - state_ns_ <= age_ns ? &*state_ : nullptr;
  }

  [[nodiscard]] const std::optional<msg::SupervisorStatus>& supervisor() const { return supervisor_; }
  [[nodiscard]] const std::optional<msg::State>& state() const { return state_; }

 private:
  std::optional<msg::SupervisorStatus> supervisor_;
  std::optional<msg::State> state_;
  struct Arrived {
    msg::Header header;
    std::int64_t arrival_ns;
  };
  std::deque<Arrived> statuses_;                   ///< of the last kRequestLife_ns, oldest first
  std::int64_t supervisor_ns_ = 0, state_ns_ = 0;  ///< monotonic arrival
};

/// "EPOCH-TICK" of a sample.
[[nodiscard]] std::string status_id(const msg::Header& header);

/// JSON text; bytes from the bus that are not valid UTF-8 are replaced.
[[nodiscard]] std::string text_of(const nlohmann::ordered_json& json);

}  // namespace crane::dashboard
