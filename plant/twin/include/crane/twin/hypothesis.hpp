#pragma once
/// Causes that the twin can name. Most causes are terms of plant/model with a reference size. A deviation
/// below half of the reference size raises no event.
#include <span>
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/twin/columns.hpp"

namespace crane::twin {

/// One row of the table of the causes. docs/twin.md shows the table.
struct CauseKind {
  const char* name;  ///< name of a term of the model or of a step of the residual, or "unknown"
  /// parameter of the term that is the size of the cause; nullptr: not a term of the model
  const char* parameter;
  std::vector<double> sizes;  ///< reference sizes; empty: no hypothesis
  bool either_sign;           ///< true: one hypothesis for each sign
  double shown_per_size;      ///< factor from `sizes` to the unit in `sizes_text`
  const char* sizes_text;     ///< text of the document after `sizes`; without `sizes` the whole cell
  const char* meaning;
  const char* remedy;  ///< AXIS stands for the name of the axis
};

inline constexpr const char* kEncoderSlip = "encoder_slip";
inline constexpr const char* kLoadPushed = "load_pushed";
inline constexpr const char* kUnknown = "unknown";

/// All causes, in the order of the document.
[[nodiscard]] std::span<const CauseKind> cause_kinds();
/// @pre a cause has this name
[[nodiscard]] const CauseKind& cause_kind(std::string_view name);
/// The table as Markdown.
[[nodiscard]] std::string cause_table();

struct Hypothesis {
  std::string cause;                      ///< CauseKind::name
  std::string axis;                       ///< axis of the term; may be empty
  std::vector<plant::TermSetting> terms;  ///< the term with the reference size; empty for a slipping encoder
  PerColumn slip{};        ///< reference size of a slipping encoder, which is not part of the model
  double reference = 0;    ///< reference size in `unit`, not 0
  bool only_near = false;  ///< true: valid only for sizes near the reference (not linear)
  std::string unit;
  std::string remedy;
};

/// Hypotheses that apply to a rig: friction and gain of each drive, slipping position encoders, payload,
/// cable length, zero of the swing encoders.
[[nodiscard]] std::vector<Hypothesis> hypotheses_for(const configuration::Rig& rig);

}  // namespace crane::twin
