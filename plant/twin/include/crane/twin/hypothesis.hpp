#pragma once
/// Causes the twin can name: most are a term of plant/model with a reference size. Half of the reference size
/// is what the twin lets pass without an event.
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/twin/columns.hpp"

namespace crane::twin {

struct Hypothesis {
  std::string cause;                      ///< name of the term
  std::string axis;                       ///< as the term has it
  std::vector<plant::TermSetting> terms;  ///< the reference size of it
  PerColumn slip{};                       ///< of a slipping encoder, which is no matter of the model
  double reference = 0;                   ///< that size, in `unit`, not 0
  bool only_near = false;                 ///< says nothing about sizes far from the reference
  std::string unit;
  std::string remedy;
};

/// Those that exist on this rig: friction and gain of each drive, slipping position encoders, payload, cable
/// length, zero of the swing encoders.
[[nodiscard]] std::vector<Hypothesis> hypotheses_for(const configuration::Rig& rig);

}  // namespace crane::twin
