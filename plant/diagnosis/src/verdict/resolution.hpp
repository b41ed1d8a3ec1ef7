#pragma once
/// Laws of friction that the rows are too far apart to tell.
#include "crane/diagnosis/diagnosis.hpp"
#include "search/search.hpp"

namespace crane::diagnosis {

/// Rows that an axis without voltage needs for the speeds from `speed` to 0.
/// @param speed  m/s or rad/s, > 0
/// @param at     place of the crane; its speeds do not count
[[nodiscard]] double rows_to_stop(const Crane& crane, plant::Axis axis, double speed, plant::State at,
                                  double period_s);

/// Takes the names of effects off that act only at speeds that no row shows: data cannot tell them from
/// another law of standstill, for example from the elastic deflection before an axis slips. Such an effect
/// stays in the extended model. The other effects keep their names where they are acceptable without it;
/// otherwise the verdict is `unknown`.
/// @param effects the causes of the diagnosis, in their order
void name_what_rows_show(const Study& study, const Hypotheses& hypotheses, const Effects& effects,
                         Diagnosis& diagnosis);

}  // namespace crane::diagnosis
