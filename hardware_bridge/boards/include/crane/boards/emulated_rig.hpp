#pragma once
/// The rig at the plugs of an emulated card, and its time. Either in this process, or in one of its own
/// (crane_emulated_rig), which goes on when the bridge dies or hangs, as a real rig does.
#include <memory>
#include <string>

#include "crane/boards/emulated_servo_to_go.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bridge {

class EmulatedRig : public Connector {
 public:
  /// Where the card keeps its state.
  [[nodiscard]] virtual CardState& card() noexcept = 0;
  /// Lets the rig's time run on to `time_ns`, where it does not run by itself. @throws BoardError when it
  /// does not answer
  virtual void advance_to(std::int64_t time_ns) = 0;
  /// A push against the load.
  virtual void kick(double radial_radps, double tangential_radps) = 0;
  /// @throws BoardError when the rig has stopped
  virtual void require_alive() = 0;
};

}  // namespace crane::bridge
