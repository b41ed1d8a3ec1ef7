#pragma once
/// Laws and gains that the tuning compares.
#include <string>
#include <utility>
#include <vector>

#include "crane/configuration/rig.hpp"

namespace crane::tuning {

struct Candidate {
  std::string controller;
  /// Keys of [controller] and their values, which replace those of the rig file.
  std::vector<std::pair<std::string, double>> gains;
  bool observer = false;  ///< swing_observer

  /// "gain_scheduling_full, full_state_forward_gain_vpm = 4, swing_observer"
  [[nodiscard]] std::string label() const;
};

/// @return the rig with the law and gains of the candidate
[[nodiscard]] configuration::Rig with_candidate(configuration::Rig rig, const Candidate& candidate);

/// All candidates. The ranking keeps their order for equal mean settling times.
[[nodiscard]] std::vector<Candidate> candidates();

}  // namespace crane::tuning
