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
  double null = 0;           ///< value at which the parameter has no effect
  double low = 0, high = 0;  ///< physical bounds of the signed value
  double step = 0;  ///< step of the finite difference: large enough to be visible, small enough for a slope
  bool often_at_bound = false;  ///< true: a rough fit first holds the value at each bound
};

/// One form of a candidate. A probe is the term with a small amount (`large_probe`: a large one). The score
/// test uses the probes of one shape jointly.
struct Shape {
  std::vector<plant::TermSetting> probes;
  std::vector<double> amounts;
  bool large_probe = false;  ///< true: one large probe; its gain is the score, and the fit starts
                             ///< from its values
};

/// Variable that a force on an axis depends on.
enum class GoesWith { position, speed, reversals, time, other_position, other_command, frequency, jumps };

struct Candidate {
  std::string cause;                 ///< name of the term
  std::string axis;                  ///< "trolley", "slew", "radial", "tangential" or empty
  bool drive = false, load = false;  ///< simulations that the candidate changes
  std::vector<FreeParameter> parameters;
  /// Number of leading parameters that are amounts. If all amounts are at `null`, there is no effect for any
  /// values of the other parameters.
  std::size_t amount_count = 1;
  std::vector<Shape> shapes;
  bool one_sided = false;  ///< the amount is >= 0 or <= 0
  /// A wave over position. Its loss has many minima in the phase: its shapes are the strongest waves of the
  /// unexplained force.
  bool waves = false;
  /// A friction that is a wave over position: its shapes also contain the strongest waves of the unexplained
  /// friction.
  bool friction_waves = false;
  /// Initial values of a fit, in addition to those of the shapes, within the bounds of `parameters`. Inner
  /// coordinates that oscillate freely in each window decrease the loss only after a fit of their initial
  /// states.
  std::vector<std::vector<double>> ringing_starts;
  /// Further initial values, if the cause gives the load a second natural frequency. With these values, one
  /// natural frequency is that of the load without the cause; the argument is the other one, Hz. Some values
  /// may be outside their bounds. Empty function: the cause adds no natural frequency.
  std::function<std::vector<std::vector<double>>(double)> ringing_starts_at;
  bool rough = false;  ///< true: the loss is discontinuous; slopes do not describe it
  /// Initial values of a rough candidate. The fit begins at the one with the smallest loss.
  std::vector<std::vector<double>> rough_starts;
  std::optional<GoesWith> law;           ///< the only variable on which the force of the candidate depends
  bool changes_known_parameter = false;  ///< true: the base model contains this quantity, with another value
  /// A more common cause with nearly the same effect on the same axis. The candidate replaces it only if the
  /// data show the difference (rules::kRarerCause). Empty: none.
  std::string rarer_than;
  /// Parameter values for amounts of a shape's small probes.
  std::function<std::vector<double>(const Shape&, const std::vector<double>&)> of_amounts;

  /// True when all values are within the bounds of their parameters.
  [[nodiscard]] bool permits(const std::vector<double>& values) const;

  /// Initial values of a fit, from the amounts of the probes of a shape.
  [[nodiscard]] std::vector<double> begin(const Shape& shape, const std::vector<double>& amounts) const;

  /// True when the cause changes the simulation of the output directly. The load simulation prescribes the
  /// motion of the support, so that a sensor or a backlash of the support also changes the simulated
  /// swing.
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
