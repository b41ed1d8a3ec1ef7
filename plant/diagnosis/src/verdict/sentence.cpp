#include "verdict/sentence.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "rules.hpp"

namespace crane::diagnosis {
namespace {

/// Share of the stated accuracy within which a calibrated value is at its bound: rounding of the fit.
constexpr double kAtTheBound = 1e-6;

/// Calibrated values at the bound of the stated accuracy, as a sentence with a space before it; empty: none.
std::string at_the_bound(const std::vector<Calibrated>& calibrated) {
  std::string names;
  for (const Calibrated& quantity : calibrated)
    for (const Calibrated::Parameter& p : quantity.parameters) {
      if (!(p.limit > 0) || std::abs(p.value - p.null) < (1 - kAtTheBound) * p.limit) continue;
      names += (names.empty() ? "" : ", ") + quantity.name +
               (quantity.axis.empty() ? "" : " (" + quantity.axis + ")") + " " + p.name;
    }
  if (names.empty()) return "";
  return " At the bound of the stated accuracy: " + names +
         ". The accuracy of the rig file may be lower than stated, or the true cause may have no term.";
}

std::string verdict_of(const Diagnosis& d) {
  std::string names, clear, contested, rivals;
  const auto add = [](std::string& list, const char* separator, const std::string& name) {
    list += (list.empty() ? "" : separator) + name;
  };
  for (const Cause& cause : d.causes) {
    const std::string name = cause.name + (cause.axis.empty() ? "" : " (" + cause.axis + ")");
    add(names, " and ", name);
    add(cause.resampling_frequency >= rules::kClearWin ? clear : contested, " and ", name);
  }
  for (const std::string& rival : d.ambiguous_with) add(rivals, ", ", rival);
  switch (d.verdict) {
    case Verdict::none:
      return d.within_accuracy.empty() && d.calibrated.empty()
                 ? "These data show no error of the model."
                 : "These data show no error of the model beyond the accuracy of the rig file.";
    case Verdict::named:
      return "The simulation lacks " + names + ".";
    case Verdict::parameter:
      return "A parameter of the rig file has the wrong value: " + names + ".";
    case Verdict::ambiguous:
      return (clear.empty() ? "These" : "The simulation lacks " + clear + "; these") +
             " data do not distinguish " + contested + " from " + rivals + ".";
    case Verdict::unknown:
      break;
  }
  const auto& from = d.remainder.from;
  return "The model has an error that no known cause explains" +
         (from.empty() ? std::string{"."} : " (" + from[0] + ").");
}

/// Sentence, with a space before it, for causes that increase the held-out likelihood but do not decrease the
/// held-out error significantly; otherwise empty.
std::string hidden_gain(const Diagnosis& d) {
  const bool has_causes = d.verdict != Verdict::none && d.verdict != Verdict::unknown;
  if (!has_causes || !(d.held_out.nats > 0) || d.held_out.gain_ci95[0] > 0) return "";
  return (std::ostringstream{} << std::setprecision(2)
                               << " Noise and disturbance hide the decrease of the held-out error; the "
                                  "held-out likelihood increases by "
                               << d.held_out.nats << " nats.")
      .str();
}

}  // namespace

std::string sentence_of(const Diagnosis& d) {
  return verdict_of(d) + hidden_gain(d) + at_the_bound(d.calibrated);
}

}  // namespace crane::diagnosis
