/// Forces that vary a few times along the travel: data of a generator that shares nothing with the diagnosis.
#include <gtest/gtest.h>

#include "crane/diagnosis/diagnosis.hpp"
#include "laboratory/amplifier_runs.hpp"
#include "laboratory/expect_cause.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kAmplitude_v = 0.12, kTravel_m = 0.6;

/// The only cause of a diagnosis is a ripple with `periods` in the travel.
void expect_wave(double periods) {
  const double length_m = kTravel_m / periods;
  const strange::Axis axis{.amplifier = {}, .wave_v = kAmplitude_v, .wave_length_m = length_m};
  Request request;
  request.most_effects = 1;
  const Diagnosis found =
      diagnose(rig_of_axis(), inaccurate_runs_of(axis, 21), inaccurate_runs_of(axis, 22), request);
  ASSERT_NO_FATAL_FAILURE(expect_cause(found, "torque_ripple", kAmplitude_v, 0.1 * kAmplitude_v));
  EXPECT_NEAR(found.causes[0].parameters.at(2).value, length_m, 0.02 * length_m);
}

TEST(WavesOfTheTravel, WithThreePeriodsAreNamedARipple) { expect_wave(3); }

TEST(WavesOfTheTravel, WithOneAndAHalfPeriodsAreNamedARipple) { expect_wave(1.5); }

}  // namespace
}  // namespace crane::diagnosis
