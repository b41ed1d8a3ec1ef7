#pragma once
/// Causes that the twin can name. Most causes are a term of plant/model with a reference size. A deviation
/// below half of the reference size raises no event.
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/twin/columns.hpp"

namespace crane::twin {

struct Hypothesis {
  std::string cause;                      ///< name of the term
  std::string axis;                       ///< axis of the term; may be empty
  std::vector<plant::TermSetting> terms;  ///< the term with the reference size; empty for a slipping encoder
  PerColumn slip{};        ///< reference size of a slipping encoder, which is not part of the model
  double reference = 0;    ///< reference size in `unit`, not 0
  bool only_near = false;  ///< true: valid only for sizes near the reference (not linear)
  std::string unit;
  std::string remedy;
};

/// Causes without a hypothesis: an encoder that jumps, a push of the load, and a deviation that no hypothesis
/// explains. docs/twin.md lists all causes.
inline constexpr const char* kEncoderSlip = "encoder_slip";
inline constexpr const char* kLoadPushed = "load_pushed";
inline constexpr const char* kUnknown = "unknown";

/// Causes that apply to a rig: friction and gain of each drive, slipping position encoders, payload, cable
/// length, zero of the swing encoders.
[[nodiscard]] std::vector<Hypothesis> hypotheses_for(const configuration::Rig& rig);

}  // namespace crane::twin
