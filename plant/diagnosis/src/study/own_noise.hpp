#pragma once
/// Hypotheses in the noise of their own residuals.
#include "study/joint_fit.hpp"

namespace crane::diagnosis {

/// Fit and noise model alternate until a round decreases minus twice the log likelihood by less than
/// kWorthARound.
inline constexpr int kMostNoiseRounds = 6;
inline constexpr double kWorthARound = 2;

/// The base model: the crane of the rig file, without effects.
struct BaseModel {
  Nuisance exact;       ///< for an exact rig file
  Nuisance calibrated;  ///< with fitted inaccuracies
  BaseSlopes slopes;    ///< of the calibrated base model
};

/// Noise and disturbance of the residuals of the crane with these effects, without inaccuracies.
[[nodiscard]] Nuisance learnt_nuisance(const Study& study, const Effects& effects = {});

/// Learns the nuisance parameters of the base model. The fit of the inaccuracies alternates with the noise:
/// an error within the accuracy of the rig file belongs to the base model, not to the noise.
[[nodiscard]] BaseModel learnt_base_model(const Study& study);

/// The base model as a hypothesis, in the noise of the data.
[[nodiscard]] Fitted base_fit(const WhitenedData& data);

/// Fits the effects from these values in the noise of `near`, then learns the noise of the residuals. Ranks
/// hypotheses for refit_with_own_noise(). @param data in the noise of `near`
/// @param near  fit of some of the effects
[[nodiscard]] Fitted first_fit(const WhitenedData& data, const Effects& effects, const Fitted& near);

/// Alternates the fit of effects and inaccuracies with the noise while the likelihood increases.
[[nodiscard]] Fitted refit_with_own_noise(const Study& study, const BaseModel& base, const Fitted& first_fit);

/// Minus twice the log likelihood of the held-out data by block. The noise is learnt from the residuals of
/// the held-out data, because the error of a model depends on the motion.
[[nodiscard]] Blocks held_out_deviance(const Study& study, const Fitted& fitted);

}  // namespace crane::diagnosis
