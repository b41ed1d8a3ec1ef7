#pragma once
/// Operator's side of a session of the stick: requests the session, sends crane/jog, measures the motion.
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "cli/operator_request.hpp"

namespace crane::cli {

using Deflection = std::array<double, 3>;

/// Travel of each axis and largest swing since the start of the measurement.
struct Measured {
  std::array<double, 3> from{}, to{};  ///< m, rad, m of cable
  double largest_swing_rad = 0;
};

class StickSession {
 public:
  explicit StickSession(bus::Bus& bus);

  /// Waits for a sample of crane/state, because every sample of crane/jog contains its tick. Then requests a
  /// session for the selected axes.
  /// @throws NoAnswer when no state or no answer arrives
  [[nodiscard]] Answer begin(const std::array<bool, 3>& selected, const Patience& patience = {});
  /// Sends the value of `stick` every 20 ms until `over` returns true. `stick` returns nothing while it is
  /// released.
  /// @param stops  true: a stop signal ends the wait
  /// @return false at the timeout or after a stop signal
  /// @throws std::runtime_error when the crane stops, or another move or session replaces this one
  bool drive(double timeout_s, bool stops, const std::function<std::optional<Deflection>()>& stick,
             const std::function<bool()>& over);

  /// Sends a released stick until in_hold().
  /// @throws std::runtime_error like drive(), and at the timeout
  void release(double timeout_s);

  /// True when the last kHoldTicks samples of the supervisor reported HOLD.
  [[nodiscard]] bool in_hold() const { return hold_ticks_ >= kHoldTicks; }
  /// Begins a new measurement.
  void measure() { begins_ = true; }
  [[nodiscard]] const Measured& measured() const { return measured_; }

 private:
  static constexpr int kHoldTicks = 50;  // more than one, because single ticks of HOLD occur during a motion
  void await_state(double patience_s);
  void receive_states();
  void receive();
  void send(const std::optional<Deflection>& stick);

  bus::Bus& bus_;
  bus::Publisher<msg::Jog> jogs_;
  bus::Subscriber<msg::SupervisorStatus> statuses_;
  bus::Subscriber<msg::State> states_;
  std::uint64_t id_ = 0, tick_ = 0;
  std::uint64_t number_ = 0;  ///< AcceptedMove.number of the session
  bool accepted_ = false, begins_ = true;
  int hold_ticks_ = 0;
  std::int64_t send_at_ns_ = 0;
  Measured measured_;
};

}  // namespace crane::cli
