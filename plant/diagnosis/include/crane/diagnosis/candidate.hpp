#pragma once
/// Candidate causes: terms of plant/model with free parameters.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/diagnosis/replay.hpp"
#include "crane/plant/term.hpp"

namespace crane::diagnosis {

struct FreeParameter {
  std::string name, unit;
  double null = 0;           ///< no effect
  double low = 0, high = 0;  ///< physical bounds, with sign
  double step = 0;           ///< finite difference: visible and small
  bool at_a_bound = false;   ///< the value is usually one of its bounds: a rough fit first holds it at each
};

/// One form of an effect: probes of a small amount each. The score test uses the probes of one shape jointly.
struct Shape {
  std::vector<plant::TermSetting> probes;
  std::vector<double> amounts;
  bool large_probe = false;  ///< one large probe: judged by its own gain, and a start of the fit
};

/// Variable that a force on an axis depends on.
enum class GoesWith { position, speed, reversals, time, other_command, frequency, jumps };

struct Candidate {
  std::string cause;                 ///< name of the term
  std::string axis;                  ///< "trolley", "slew", "radial", "tangential" or empty
  bool drive = false, load = false;  ///< replays that it changes
  std::vector<FreeParameter> parameters;
  /// Number of leading parameters that are amounts: with all of them at `null` there is no effect, whatever
  /// the other parameters are.
  std::size_t amount_count = 1;
  std::vector<Shape> shapes;
  bool one_sided = false;  ///< the amount is >= 0 or <= 0
  /// A wave over position. Its loss has many minima in the phase: its shapes are the strongest waves of the
  /// unexplained force.
  bool waves = false;
  /// Values from which a fit may begin, beside the shapes. Inner coordinates that ring freely in each window
  /// show what they gain only after a fit of the starts. All are within the bounds of `parameters`.
  std::vector<std::vector<double>> ringing_starts;
  bool rough = false;  ///< the loss has steps: slopes do not describe it
  /// Of a rough candidate: values of which the fit compares the whole loss before it begins.
  std::vector<std::vector<double>> rough_starts;
  std::optional<GoesWith> law;           ///< the only variable of its force on its axis
  bool changes_known_parameter = false;  ///< the base model has this quantity with another value
  /// Parameter values for amounts of a shape's small probes.
  std::function<std::vector<double>(const Shape&, const std::vector<double>&)> of_amounts;

  /// Whether all values lie within the bounds of their parameters.
  [[nodiscard]] bool permits(const std::vector<double>& values) const;

  /// Start values of a fit from the amounts of the probes of a shape.
  [[nodiscard]] std::vector<double> begin(const Shape& shape, const std::vector<double>& amounts) const;

  /// Whether the cause changes the replay of the output directly. The replay of the swing prescribes the
  /// motion of the support, so that a sensor or a backlash of the support changes the replay of the swing as
  /// well.
  [[nodiscard]] bool acts_on(Output output) const {
    const bool of_drive = output == kTrolleyPosition || output == kSlewAngle;
    const bool of_support = axis == "trolley" || axis == "slew";
    return of_drive ? drive && (axis.empty() || axis == axis_of(output))
                    : load && (axis.empty() || axis == axis_of(output) || of_support);
  }

  /// @pre the axis is "trolley" or "slew"
  [[nodiscard]] Output drive_output() const { return static_cast<Output>(plant::drive_axis(axis)); }

  [[nodiscard]] std::string label() const { return axis.empty() ? cause : cause + " (" + axis + ")"; }
  [[nodiscard]] plant::TermSetting setting(const std::vector<double>& values) const;
};

/// All candidates of this rig, in the order of the report.
[[nodiscard]] std::vector<Candidate> candidates_for(const configuration::Rig& rig,
                                                    const std::vector<PreparedRun>& runs);

}  // namespace crane::diagnosis
