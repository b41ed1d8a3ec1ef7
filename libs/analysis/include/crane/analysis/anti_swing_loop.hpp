#pragma once
/// Characteristic equations of tracking PD with a linear anti-swing law. The unit of time is the load period.
/// Source: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003; signs and errata:
/// docs/equations.md.
///   pd        (s^2 + 4 pi^2)(s^2 + K_d s + K_p) - s^2 (K_ps + K_ds s) = 0                  (3.39), (3.45)
///   delayed_1 (s^2 + 4 pi^2)(s^2 + K_d s + K_p) - s^2 K_del exp(-tau s) = 0                (3.47), (3.48)
///   delayed_2 (s^2 + 4 pi^2)(s^2 + K_d s + K_p) - s^2 K_del (K_d s + K_p) exp(-tau s) = 0  (3.50)
#include <array>
#include <string_view>

#include "crane/analysis/quasi_polynomial.hpp"

namespace crane::analysis {

enum class AntiSwing { pd, delayed_1, delayed_2 };

/// The two parameters of a law: K_ps, K_ds or K_del, tau.
struct GainPoint {
  double first = 0, second = 0;
};

/// `points` >= 2 equally spaced values from `low` to `high`, including both.
struct GainRange {
  double low = 0, high = 1;
  int points = 2;
  [[nodiscard]] double at(int index) const noexcept { return low + (high - low) * index / (points - 1); }
};

struct AntiSwingKind {
  AntiSwing law;
  std::string_view name;
  std::string_view first_name, second_name;
  std::string_view figure;        ///< number of the figure in the source
  GainPoint printed;              ///< gains of the source, with the tower sign
  std::string_view printed_text;  ///< gains as printed
  double printed_damping;         ///< damping ratio that the source reads from its figure
  GainRange first, second;        ///< ranges of the figure
};

inline constexpr std::array<AntiSwingKind, 3> kAntiSwingKinds{{
    {AntiSwing::pd, "pd", "K_ps", "K_ds", "3.16", {-30, 8}, "(30, -8)", 0.45, {-80, 20, 61}, {-4, 16, 61}},
    {AntiSwing::delayed_1,
     "delayed_1",
     "K_del",
     "tau",
     "3.17",
     {-90, 0.1},
     "(-90, 0.1)",
     0.45,
     {-200, 20, 61},
     {0.02, 0.32, 61}},
    {AntiSwing::delayed_2,
     "delayed_2",
     "K_del",
     "tau",
     "3.19",
     {-0.33, 0.31},
     "(0.33, 0.31)",
     0.3,
     {-0.9, 0.1, 61},
     {0.02, 0.5, 61}},
}};

/// @return nullptr when no law has this name
[[nodiscard]] const AntiSwingKind* find_anti_swing(std::string_view name) noexcept;

/// K_p and K_d of (3.41); the defaults satisfy (3.42), critical damping.
struct TrackingGains {
  double proportional = 100, derivative = 20;
};

/// Second-order Butterworth low-pass filter on the swing angle, in continuous time. cutoff = 2 pi T f_c
/// with f_c the cut-off frequency in Hz; 0: no filter. The delay at low frequency is sqrt(2) / cutoff.
struct SwingFilter {
  double cutoff = 0;
};

/// @return characteristic function of the closed loop. @pre gains.second >= 0 for the delayed laws
[[nodiscard]] QuasiPolynomial characteristic(AntiSwing law, const GainPoint& gains,
                                             const TrackingGains& tracking = {},
                                             const SwingFilter& filter = {});

/// Characteristic function of delayed_2 with ideal tracking: s^2 + 4 pi^2 - K_del s^2 exp(-tau s), a neutral
/// equation.
[[nodiscard]] QuasiPolynomial perfectly_tracked_delayed_2(const GainPoint& gains);

}  // namespace crane::analysis
