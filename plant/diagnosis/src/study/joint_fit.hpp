#pragma once
/// Joint fit of effects and inaccuracies of the rig file.
#include "study/fit.hpp"

namespace crane::diagnosis {

/// Plain slopes along the inaccuracies of the base model, at its simulation. A hypothesis with a similar
/// simulation has nearly the same ones.
struct BaseSlopes {
  Simulation simulation;
  std::vector<PlainSlope> of_values;  ///< by value of the inaccuracies; empty: unknown
};

/// Fits the effects jointly with the inaccuracies that are visible in the same parts of the data; all
/// inaccuracies if there are no effects. Sets the inaccuracies of `fitted.nuisance`.
/// @param along  plain slopes of the effects, or also of these inaccuracies, at the values of the fit; those
/// of both on return
void fit_jointly(const WhitenedData& data, const BaseSlopes& base, Fitted& fitted, Slopes& along);

}  // namespace crane::diagnosis
