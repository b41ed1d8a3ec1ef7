#pragma once
/// Sensitivity: one quantity at a time departs from what the controllers believe or were designed with, and
/// the same move is made again.
#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "experiments/comparison_run.hpp"

namespace crane::cli {

/// One departure. It changes scenario and rig before the scenario starts the rig.
struct Departure {
  std::string quantity;  ///< "cable_length", ...; empty: nothing departs
  std::string unit;      ///< of value
  double value = 0;
  std::function<void(experiments::PlannedRun&)> change;
};

/// Delay of the Butterworth low-pass of order 2 for slow signals, sqrt(2) / (2 pi cut-off). @pre
/// cut_off_ratio > 0
[[nodiscard]] double filter_delay_s(double cut_off_ratio, double period_s);

/// Those that make sense for the plan's controller, nothing departing first:
///   cable_length, load_mass        true ones, -50 to 50 % of what is measured or believed
///   friction_compensation          -20 to 20 % of what is compensated
///   command_delay                  1 to 3 ticks more than the loop has, trolley and slew
///   rate_filter                    cut-off over sampling frequency in front of the differentiators, 0: none
///   swing_filter                   the same filter also on the swing angles, its cut-off
///   swing_filter_for_delay         the same, and the delayed law's own delay less that of the filter
///   gain                           -50 to 50 % of the forward gain K or of the anti-swing law's own gains
[[nodiscard]] std::vector<Departure> departures(const experiments::PlannedRun& plan);

struct DepartedRun {
  std::string quantity, unit;
  double value = 0;
  experiment::ComparedRun run;
};

/// Figures that a run does not have are empty.
void write_sensitivity_csv(std::ostream& out, std::span<const DepartedRun> runs);
/// Per scenario a table, departures by controllers: settling time in s / residual swing in degrees.
void write_sensitivity_markdown(std::ostream& out, std::span<const DepartedRun> runs);

}  // namespace crane::cli
