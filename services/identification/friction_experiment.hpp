#pragma once
/// Identifies the friction of one drive by experiments with the whole stack. Source: H. M. Omar, Control of
/// Gantry and Tower Cranes, Virginia Tech, 2003, section 4.4.
///   multi_sine/   the axis follows (4.11) or (4.14) without friction compensation: b, c, K_m
///   break_away/   a slow sine raises the voltage until the axis moves, several times in both directions
///   steps/        steps in both directions with the new compensation; figures 4.7, 4.9
/// break_away gives the stiction; steps are compared with the linear axis (3.4).
/// Each directory contains the files of a run (experiment_run.hpp). The parent directory contains scenarios,
/// rig files, friction.json, friction.svg, and identified.toml, a rig file that extends the given one by the
/// new values.
#include <optional>

#include "crane/identification/break_away.hpp"
#include "crane/identification/friction.hpp"
#include "crane/identification/validation.hpp"
#include "experiments/experiment_run.hpp"

namespace crane::identification {

struct FrictionExperimentOptions {
  std::filesystem::path rig;
  std::size_t axis = plant::kTrolley;  ///< or slew
  std::filesystem::path directory;     ///< created when missing
  double duration_s = 60;              ///< duration of the multi-sine
  double zero_band = 0.1;              ///< d_s, m/s or rad/s (section 4.4.1)
  double cutoff_ratio = 0.1;           ///< omega_c / f_s (end of section 3.1); 0: no filter
  bool in_process = false;
  bool realtime = false;  ///< true: real time as on a rig, with a CSV file per run and no recording
  stack::Plant plant = stack::Plant::simulated;
  bool picture = true;
  runtime::BusOptions bus;
  std::map<std::string, std::string> vendors;
};

/// Estimates of both regressions from the same rows.
struct FrictionEstimates {
  identification::FrictionEstimate dissertation, midpoint;         ///< with K_m of the rig file
  std::optional<identification::FrictionEstimate> midpoint_joint;  ///< midpoint regression with estimated K_m
  std::string gain_refusal;                                        ///< reason when K_m could not be estimated
};

struct FrictionExperimentResult {
  std::string rig;
  std::size_t axis = plant::kTrolley;
  double amplitude_share = 1;  ///< amplitude / amplitude of (4.11) or (4.14)
  FrictionEstimates estimates;
  identification::StictionEstimate stiction;
  identification::Deviation compensated;    ///< deviation of the steps from the linear axis
  identification::Deviation uncompensated;  ///< deviation of the same steps without compensation
  double step = 0;                          ///< length of a step, m or rad
  std::filesystem::path fragment;           ///< identified.toml
  std::string difference_from_start;        ///< as experiments::RealtimeRuns::difference_from_start()
};

/// @throws identification::IdentificationError when the run does not determine the friction or contradicts
///   the model
[[nodiscard]] FrictionEstimates estimate_both(const identification::AxisRun& run, double zero_band,
                                              double cutoff_ratio, double gain);

/// @throws configuration::ConfigurationError, RunError, identification::IdentificationError,
/// plot::PictureError
[[nodiscard]] FrictionExperimentResult identify_friction(const FrictionExperimentOptions& options);

/// @return text of a rig file that extends `rig` by the identified values, with compensation
[[nodiscard]] std::string friction_fragment(const std::filesystem::path& rig, std::size_t axis,
                                            const identification::FrictionEstimate& friction,
                                            const identification::StictionEstimate& stiction);

[[nodiscard]] nlohmann::ordered_json to_json(const FrictionEstimates& estimates);
[[nodiscard]] nlohmann::ordered_json to_json(const FrictionExperimentResult& result);

}  // namespace crane::identification
