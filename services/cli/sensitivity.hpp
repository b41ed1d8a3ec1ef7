#pragma once
/// Sensitivity analysis: repeats the same move with one quantity at a time perturbed.
#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "experiments/comparison_run.hpp"

namespace crane::cli {

/// One quantity with a value that differs from its nominal value.
struct Perturbation {
  std::string quantity;  ///< "cable_length", ...; empty: nominal run
  std::string unit;      ///< unit of `value`
  double value = 0;
  std::function<void(experiments::PlannedRun&)> change;  ///< changes scenario and rig before the start
};

/// Low-frequency delay of the second-order Butterworth filter, sqrt(2) / (2 pi cut-off).
/// @pre cutoff_ratio > 0
[[nodiscard]] double filter_delay_s(double cutoff_ratio, double period_s);

/// Perturbations that apply to the controller of the plan; the first one is the nominal run:
///   cable_length, load_mass        true value, -50 to 50 % relative to the nominal value
///   friction_compensation          -20 to 20 % of the compensated friction
///   command_delay                  1 to 3 additional ticks, trolley and slew
///   rate_filter                    cut-off / sampling frequency before the differentiators; 0: no filter
///   swing_filter                   the same filter also on the swing angles
///   swing_filter_for_delay         swing_filter, with the delay of the law reduced by that of the filter
///   gain                           -50 to 50 % of the forward gain K or of the gains of the anti-swing law
[[nodiscard]] std::vector<Perturbation> perturbations(const experiments::PlannedRun& plan);

struct PerturbedRun {
  std::string quantity, unit;
  double value = 0;
  experiment::ComparedRun run;
};

/// Writes one row per run; missing figures are empty.
void write_sensitivity_csv(std::ostream& out, std::span<const PerturbedRun> runs);
/// Writes a table for each scenario; rows are perturbations, columns are controllers: settling time in s /
/// residual swing in degrees.
void write_sensitivity_markdown(std::ostream& out, std::span<const PerturbedRun> runs);

}  // namespace crane::cli
