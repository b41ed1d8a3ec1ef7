#pragma once
/// State of the crane, its cause and remedy, and the supervisor's answer to each possible request.
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "observation/sample.hpp"

namespace crane::dashboard {

class Situation {
 public:
  /// Age at which the newest sample becomes invalid; the supervisor publishes every tick.
  static constexpr std::int64_t kSilent_ns = 1'000'000'000;

  void add(const observation::Sample& sample);
  /// JSON of the situation. Two texts differ only when information for the operator differs.
  [[nodiscard]] nlohmann::ordered_json json(std::int64_t now_ns) const;

  [[nodiscard]] const std::optional<msg::SupervisorStatus>& supervisor() const { return supervisor_; }
  [[nodiscard]] const std::optional<msg::State>& state() const { return state_; }

 private:
  std::optional<msg::SupervisorStatus> supervisor_;
  std::optional<msg::State> state_;
  std::int64_t supervisor_ns_ = 0, state_ns_ = 0;  ///< monotonic arrival
};

/// JSON text; bytes from the bus that are not valid UTF-8 are replaced.
[[nodiscard]] std::string text_of(const nlohmann::ordered_json& json);

}  // namespace crane::dashboard
