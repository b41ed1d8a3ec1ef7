#pragma once
/// The friction of one drive identified by experiments on the whole stack, section 4.4:
///   multi_sine/   the axis follows (4.11) or (4.14) without friction compensation: b, c, K_m
///   break_away/   a slow sine raises the voltage until the axis moves, both ways, several times: stiction
///   steps/        steps both ways with the new compensation, against the linear axis (3.4): figures 4.7, 4.9
/// Each directory is a run as `crane run` leaves it. Beside them: its scenario and rig file, friction.json,
/// friction.svg, and identified.toml, a rig file that extends the one given by the new values.
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
  double duration_s = 60;              ///< of the multi-sine
  double zero_band = 0.1;              ///< d_s, m/s or rad/s (section 4.4.1)
  double cutoff_ratio = 0.1;           ///< omega_c / f_s (end of section 3.1); 0: unfiltered
  bool in_process = false;
  bool realtime = false;  ///< as on a rig: a CSV file per run, no recording
  stack::Plant plant = stack::Plant::simulated;
  bool picture = true;
  runtime::BusOptions bus;
  std::map<std::string, std::string> vendors;
};

/// Both regressions on the same rows, and K_m estimated with the midpoint one.
struct FrictionEstimates {
  identification::FrictionEstimate dissertation, midpoint;         ///< with K_m of the rig
  std::optional<identification::FrictionEstimate> midpoint_joint;  ///< with K_m estimated
  std::string gain_refusal;                                        ///< why K_m could not be estimated
};

struct FrictionExperimentResult {
  std::string rig;
  std::size_t axis = plant::kTrolley;
  double amplitude_share = 1;  ///< of the amplitude of (4.11) or (4.14)
  FrictionEstimates estimates;
  identification::StictionEstimate stiction;
  identification::Deviation compensated;    ///< steps against the linear axis
  identification::Deviation uncompensated;  ///< the same steps without compensation
  double step = 0;                          ///< m or rad
  std::filesystem::path fragment;           ///< identified.toml
};

/// @throws identification::IdentificationError  a run cannot answer, or contradicts the model
[[nodiscard]] FrictionEstimates estimate_both(const identification::AxisRun& run, double zero_band,
                                              double cutoff_ratio, double gain);

/// @throws configuration::ConfigurationError, RunError, identification::IdentificationError,
/// plot::PictureError
[[nodiscard]] FrictionExperimentResult identify_friction(const FrictionExperimentOptions& options);

/// The rig file that extends `rig` by what was identified; its compensation is on.
[[nodiscard]] std::string friction_fragment(const std::filesystem::path& rig, std::size_t axis,
                                            const identification::FrictionEstimate& friction,
                                            const identification::StictionEstimate& stiction);

[[nodiscard]] nlohmann::ordered_json to_json(const FrictionEstimates& estimates);
[[nodiscard]] nlohmann::ordered_json to_json(const FrictionExperimentResult& result);

}  // namespace crane::identification
