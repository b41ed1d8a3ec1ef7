#pragma once
/// Moves of an operator between the sessions of a stick: a step of inching, the return to the stop point.
#include <functional>
#include <optional>
#include <string>

#include "cli/inching.hpp"
#include "cli/move_follower.hpp"
#include "cli/operator_request.hpp"

namespace crane::cli {

class JogMoves {
 public:
  explicit JogMoves(bus::Bus& bus);

  /// Takes the samples that have arrived.
  void receive();
  /// Newest positions (m, rad, m of cable); nothing before the first sample.
  [[nodiscard]] const std::optional<std::array<double, 3>>& measured() const { return measured_; }
  [[nodiscard]] const std::optional<std::array<double, 3>>& reference() const { return reference_; }

  /// Requests a move and waits for its end. The supervisor refuses it like every other move; the reason is
  /// then printed after `what`. The crane is stopped (and locked) when the wait ends earlier.
  /// @param stopped  why the crane must stop now; empty: it need not
  /// @return false: refused
  /// @throws std::runtime_error, NoAnswer: the crane has stopped, with reason and remedy
  [[nodiscard]] bool execute(const char* what, const AxisTargets& targets, double timeout_s,
                             const std::function<std::string()>& stopped);

 private:
  [[noreturn]] void stop(const char* what, const std::string& why);

  bus::Bus& bus_;
  MoveFollower follower_;
  bus::Subscriber<msg::State> states_;
  bus::Subscriber<msg::Reference> references_;
  std::optional<std::array<double, 3>> measured_, reference_;
};

}  // namespace crane::cli
