#pragma once
/// Candidates: every effect the diagnosis may name, as a term of plant/model with what is free in it.
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
  double low = 0, high = 0;  ///< physical bounds; signs are in them
  double step = 0;           ///< for slopes: a change that can be seen and is still small
};

/// A way the effect may look: settings of a small amount of it, each with its amount. The score test looks
/// along the probes of one shape together.
struct Shape {
  std::vector<plant::TermSetting> probes;
  std::vector<double> amounts;
  bool as_it_is = false;  ///< one probe, large: what it gains itself counts, and a fit begins there
};

/// What a force on an axis may go with.
enum class GoesWith { position, speed, reversals, time, other_command, frequency, jumps };

struct Candidate {
  std::string cause;                 ///< name of the term
  std::string axis;                  ///< "trolley", "slew", "radial", "tangential" or empty
  bool drive = false, load = false;  ///< replays it shows in
  std::vector<FreeParameter> parameters;
  std::vector<Shape> shapes;
  bool one_sided = false;  ///< a small amount has a sign
  /// Between two guesses of its phase a wave over position does nothing at first, or harm: its shapes are the
  /// waves of what nothing else explains.
  bool waves = false;
  bool rough = false;                    ///< its loss goes over the values in steps, which no slope tells of
  std::optional<GoesWith> law;           ///< what the force it makes on its axis is a law of, if of one thing
  bool changes_known_parameter = false;  ///< the base model has this quantity; the rig file's value is off
  /// Values that the amounts of a shape's small probes come to.
  std::function<std::vector<double>(const Shape&, const std::vector<double>&)> of_amounts;

  /// Values to begin a fit with, from the amounts of the probes of one shape.
  [[nodiscard]] std::vector<double> begin(const Shape& shape, const std::vector<double>& amounts) const;

  /// Whether it changes an output by itself, not by what else moves.
  [[nodiscard]] bool acts_on(Output output) const {
    const bool of_drive = output == kTrolleyPosition || output == kSlewAngle;
    return (of_drive ? drive : load) && (axis.empty() || axis == axis_of(output));
  }

  /// @pre the axis is "trolley" or "slew"
  [[nodiscard]] Output drive_output() const { return static_cast<Output>(plant::drive_axis(axis)); }

  [[nodiscard]] std::string label() const { return axis.empty() ? cause : cause + " (" + axis + ")"; }
  [[nodiscard]] plant::TermSetting setting(const std::vector<double>& values) const;
};

/// Everything that can be wrong with this rig, in the order of the documentation.
[[nodiscard]] std::vector<Candidate> candidates_for(const configuration::Rig& rig,
                                                    const std::vector<PreparedRun>& runs);

}  // namespace crane::diagnosis
