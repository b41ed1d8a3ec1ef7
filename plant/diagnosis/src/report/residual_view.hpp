#pragma once
/// What a simulation leaves of the held-out data, column by column, beside what it may depend on.
#include <string>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"

namespace crane::diagnosis {

/// Something the residual is drawn against.
struct Abscissa {
  std::string label;  ///< "speed [m/s]"
  std::vector<double> values;
};

/// Runs one after the other; residuals in mm or mrad, simulation in windows of about two seconds.
struct ResidualView {
  std::string column;
  std::string unit;
  std::vector<double> baseline, extended;
  std::vector<Abscissa> against;  ///< each as long as the residuals
};

/// "mm" or "mrad".
[[nodiscard]] std::string residual_unit(const std::string& column);
/// File and its directory: every run of `crane run` is called recording.mcap.
[[nodiscard]] std::string short_name(const std::string& run);

/// The simulation of a whole run drifts away from what starts it; so the free motion that a wrong start would
/// give is taken out of every window, straight for a drive and swinging for a load.
[[nodiscard]] std::vector<ResidualView> residual_views(const Diagnosis& diagnosis,
                                                       const configuration::Rig& rig,
                                                       const std::vector<Run>& test);

}  // namespace crane::diagnosis
