#pragma once
/// Residuals of the held-out data by column, with the variables that they may depend on.
#include <string>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"

namespace crane::diagnosis {

/// Variable that the residual is plotted against.
struct Abscissa {
  std::string label;  ///< "speed [m/s]"
  std::vector<double> values;
};

/// Residuals in mm or mrad in windows of about 2 s, runs one after the other.
struct ResidualView {
  std::string column;
  std::string unit;
  std::vector<double> baseline, extended;
  std::vector<Abscissa> against;  ///< each as long as the residuals
};

/// "mm" or "mrad".
[[nodiscard]] std::string residual_unit(const std::string& column);
/// Directory and file: every recording of `crane run` has the same file name.
[[nodiscard]] std::string short_name(const std::string& run);

/// A simulation of a whole run drifts: the free motion of a wrong start is removed from each window, a
/// straight line for a drive and a swing for a load.
[[nodiscard]] std::vector<ResidualView> residual_views(const Diagnosis& diagnosis,
                                                       const configuration::Rig& rig,
                                                       const std::vector<Run>& test);

}  // namespace crane::diagnosis
