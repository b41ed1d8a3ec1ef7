#pragma once
/// The rig at the connectors of an emulated card, and the time of this rig. The rig runs in this process or
/// in a separate process (crane_emulated_rig). A separate process continues when the bridge ends or hangs,
/// like a real rig.
#include <memory>
#include <string>

#include "crane/boards/emulated_servo_to_go.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bridge {

class EmulatedRig : public Connector {
 public:
  /// State of the emulated card.
  [[nodiscard]] virtual CardState& card() noexcept = 0;
  /// Lockstep: advances the rig up to `time_ns`. @throws BoardError when the rig does not answer
  virtual void advance_to(std::int64_t time_ns) = 0;
  /// Adds swing rates to the load.
  virtual void kick(double radial_radps, double tangential_radps) = 0;
  /// @throws BoardError when the rig has stopped
  virtual void require_alive() = 0;
};

}  // namespace crane::bridge
