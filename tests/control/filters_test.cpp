#include "crane/control/filters.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace crane::control {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;
constexpr double kRate_hz = 100;

/// Frequency response, measured with cos and sin after the transient has decayed.
Complex response(const FilterSection& section, double frequency_hz) {
  FilterMemory real, imaginary;
  Complex output;
  const double w = 2 * pi * frequency_hz / kRate_hz;
  int k = 0;
  for (; k < 4000; ++k)
    output = {step(section, real, std::cos(w * k)), step(section, imaginary, std::sin(w * k))};
  return output / std::polar(1.0, w * (k - 1));
}

TEST(Differentiators, ApproachTheIdealDifferentiatorAtLowFrequency) {
  const std::array sections{backward_difference(kRate_hz), al_alaoui_first_order(kRate_hz),
                            al_alaoui_second_order(kRate_hz)};
  // Delay of each differentiator at low frequency in ticks, from the phase of its transfer function.
  const std::array delay_ticks{0.5, 0.375, 0.5774};
  for (std::size_t i = 0; i < sections.size(); ++i)
    for (const double f : {0.2, 0.5, 1.0, 2.0}) {
      const Complex ratio = response(sections[i], f) / Complex(0, 2 * pi * f);
      EXPECT_NEAR(std::abs(ratio), 1, 1e-3) << "filter " << i << " at " << f;
      EXPECT_NEAR(-std::arg(ratio) * kRate_hz / (2 * pi * f), delay_ticks[i], 5e-3) << "filter " << i;
    }
}

/// Gain of each differentiator in closed form, as the inverse of its integrator: rectangular rule; 3/4
/// rectangular and 1/4 trapezoidal rule; Simpson's rule, whose zero outside the unit circle is reflected,
/// which preserves the gain.
double backward_gain(double w) { return 2 * std::sin(w / 2); }
double first_order_gain(double w) {
  return 2 * std::sin(w / 2) / std::sqrt(1 - 7.0 / 32 * (1 - std::cos(w)));
}
double second_order_gain(double w) { return 3 * std::sin(w) / (2 + std::cos(w)); }

struct Differentiator {
  FilterSection section;
  double (*gain)(double);  ///< per sample, at w rad per sample
  double good_up_to_hz;    ///< largest frequency up to which the gain is within 1 % of the ideal gain w
};

const Differentiator kDifferentiators[] = {{backward_difference(kRate_hz), backward_gain, 7.81},
                                           {al_alaoui_first_order(kRate_hz), first_order_gain, 14.99},
                                           {al_alaoui_second_order(kRate_hz), second_order_gain, 17.77}};

TEST(Differentiators, HaveTheGainOfTheIntegratorTheyInvertAtEveryFrequency) {
  for (const auto& [section, gain, good_up_to_hz] : kDifferentiators)
    for (double f = 0.5; f < 50; f += 1.7)
      EXPECT_NEAR(std::abs(response(section, f)) / kRate_hz, gain(2 * pi * f / kRate_hz), 1e-9) << f;
}

TEST(Differentiators, AreWithinOnePercentUpToTheirStatedFrequencies) {
  for (const auto& [section, gain, good_up_to_hz] : kDifferentiators) {
    const auto error = [&section = section](double f) {
      return std::abs(std::abs(response(section, f)) / (2 * pi * f) - 1);
    };
    for (double f = 0.5; f < good_up_to_hz; f += 0.5) EXPECT_LE(error(f), 0.01) << f;
    EXPECT_LE(error(0.99 * good_up_to_hz), 0.01);
    EXPECT_GE(error(1.02 * good_up_to_hz), 0.01);
  }
}

TEST(Differentiators, AreExactOnARampAfterTheTransient) {
  for (const auto& section :
       {backward_difference(kRate_hz), al_alaoui_first_order(kRate_hz), al_alaoui_second_order(kRate_hz)}) {
    FilterMemory memory = settled(section, 0);
    double speed = 0;
    for (int k = 1; k < 200; ++k) speed = step(section, memory, 0.3 * k / kRate_hz);
    EXPECT_NEAR(speed, 0.3, 1e-12);
  }
}

TEST(AlAlaouiSecondOrder, HasThePrintedCoefficientsAndMagnifiesHighFrequencyLeast) {
  const auto section = al_alaoui_second_order(1);
  EXPECT_NEAR(section.a1, 0.5358, 1e-4);  // last printed digit: 0.53590 is cut, not rounded
  EXPECT_NEAR(section.a2, 0.0718, 5e-5);
  EXPECT_NEAR(section.b0, 3 / 3.7321, 5e-5);
  const double f = 0.49 * kRate_hz;
  EXPECT_LT(std::abs(response(al_alaoui_second_order(kRate_hz), f)),
            std::abs(response(backward_difference(kRate_hz), f)));
}

TEST(Butterworth, HasTheAnalogMagnitudeAtTheWarpedFrequency) {
  for (const double ratio : {0.05, 0.1, 0.3}) {
    const auto section = butterworth_low_pass(ratio);
    for (const double f : {0.1, 1.0, 5.0, 20.0, 45.0}) {
      const double warped = std::tan(pi * f / kRate_hz) / std::tan(pi * ratio);
      EXPECT_NEAR(std::abs(response(section, f)), 1 / std::sqrt(1 + std::pow(warped, 4)), 1e-9)
          << ratio << " at " << f;
    }
    EXPECT_NEAR(std::abs(response(section, ratio * kRate_hz)), std::sqrt(0.5), 1e-9);
  }
}

TEST(Butterworth, PassesTheInputUnchangedWhenItIsOff) {
  FilterMemory memory;
  const auto section = butterworth_low_pass(0);
  for (const double sample : {1.0, -3.0, 7.5}) EXPECT_EQ(step(section, memory, sample), sample);
}

TEST(Filters, StartSettledAtTheFirstSample) {
  const auto low_pass = butterworth_low_pass(0.05);
  FilterMemory memory = settled(low_pass, 0.7);
  for (int k = 0; k < 100; ++k) EXPECT_NEAR(step(low_pass, memory, 0.7), 0.7, 1e-12);
  for (const auto& section :
       {backward_difference(kRate_hz), al_alaoui_first_order(kRate_hz), al_alaoui_second_order(kRate_hz)}) {
    memory = settled(section, 0.7);
    for (int k = 0; k < 100; ++k) EXPECT_EQ(step(section, memory, 0.7), 0);
  }
}

}  // namespace
}  // namespace crane::control
