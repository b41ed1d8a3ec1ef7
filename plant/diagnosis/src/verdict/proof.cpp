#include "verdict/proof.hpp"

#include <algorithm>
#include <map>

#include "crane/diagnosis/kinematics.hpp"
#include "rules.hpp"

namespace crane::diagnosis {
namespace {

bool acts_on(const Effects& effects, const std::string& column) {
  return std::ranges::any_of(effects, [&](const Effect& effect) {
    return std::ranges::any_of(kAllOutputs, [&](Output output) {
      return column == kOutputNames[output] && effect.candidate->acts_on(output);
    });
  });
}

/// True if the base model follows at least kStillFollowed of the motion over whole runs, and the extended
/// model follows less than kStillFollowed of what the base model follows. A friction that holds the axis
/// explains nothing. In open loop, an unknown force of a drive is integrated twice: a base model that follows
/// less would follow more or less by chance.
bool loses_motion(const HeldOut& held_out, const std::string& column) {
  const auto squares = [&column](const std::map<std::string, double>& rms) {
    const auto found = rms.find(column);
    return found == rms.end() ? 0.0 : found->second * found->second;
  };
  const double moved = squares(held_out.whole_held_value_rms);
  const double followed_before = moved - squares(held_out.whole_baseline_rms);
  const double followed = moved - squares(held_out.whole_extended_rms);
  return followed_before > rules::kStillFollowed * moved &&
         followed < rules::kStillFollowed * followed_before;
}

/// True if the error of an output on which the effects act decreases, in windows or over whole runs.
bool reduces_an_error(const HeldOut& held_out, const Effects& effects) {
  const auto smaller = [&](const auto& before, const auto& after) {
    return std::ranges::any_of(before, [&](const auto& column) {
      return acts_on(effects, column.first) && after.at(column.first) < column.second;
    });
  };
  return smaller(held_out.baseline_rms, held_out.extended_rms) ||
         smaller(held_out.whole_baseline_rms, held_out.whole_extended_rms);
}

}  // namespace

Proof proof_of(const HeldOut& held_out, const Effects& effects) {
  using enum Proof::Outcome;
  const bool nothing_held_out = held_out.baseline_rms.empty();
  if (effects.empty() || nothing_held_out) return {};
  const std::string runs = "held-out runs: ";
  for (const auto& [column, motion] : held_out.whole_extended_motion)
    if (acts_on(effects, column) && motion < rules::kStandsStill)
      return {refuted, runs + column + " moves in the measurement but stands still in the extended model"};
  for (const auto& [column, before] : held_out.whole_baseline_rms) {
    if (!acts_on(effects, column)) continue;
    if (column.starts_with("swing") &&
        held_out.whole_extended_rms.at(column) > rules::kWorseOverWholeRuns * before)
      return {refuted, runs + "over whole runs the extended model simulates " + column + " worse"};
    if (!column.starts_with("swing") && loses_motion(held_out, column))
      return {refuted, runs + "over whole runs the extended model follows " + column +
                           " less than half as well as the base model"};
  }
  if (!(held_out.likelier > rules::kHeldOutWin))
    return {unlikely, runs + "the likelihood of the extended model is not significantly higher"};
  // If the likelihood and the error are larger, the noise model of the extended model describes an error that
  // the extension does not remove. If the likelihood is larger and the error decreases insignificantly, the
  // extension is confirmed: the likelihood weighs the small errors that noise and disturbance hide.
  if (held_out.gain_ci95[1] < 0 || !reduces_an_error(held_out, effects))
    return {no_consequence, runs + "the error of the extended model is not smaller"};
  return {};
}

}  // namespace crane::diagnosis
