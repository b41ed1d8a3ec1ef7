#pragma once
/// Dry friction as a bristle with the deflection z, in units of the deflection at the sliding level.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics.hpp"

namespace mujoco_truth {

inline double sign_of(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

/// Share of the speed that relaxes the bristle: 1 for Dahl and LuGre, 0 below 70 % of the ceiling for the
/// elasto-plastic law, with which the axis does not creep there.
inline double plastic_share(StandstillLaw law, double z, double speed, double ceiling) {
  if (law != StandstillLaw::elasto_plastic) return 1;
  constexpr double kElastic = 0.7;
  const double loaded = std::abs(z) / ceiling;
  if (z * speed <= 0 || loaded < kElastic) return 0;
  if (loaded >= 1) return 1;
  return 0.5 - 0.5 * std::cos(std::numbers::pi * (loaded - kElastic) / (1 - kElastic));
}

/// @param ceiling limit of z while the axis slides at this speed: 1, larger at low speed with a Stribeck
/// excess. Dahl (1968) and LuGre (Canudas de Wit 1995): z' = (v - |v| z / ceiling) / way. Elasto-plastic:
/// Dupont (2002).
inline double bristle_slope(StandstillLaw law, double z, double speed, double ceiling, double way) {
  return (speed - plastic_share(law, z, speed, ceiling) * std::abs(speed) * z / ceiling) / way;
}

/// z after h seconds at constant speed, in closed form. The slope is linear in z with the stiff rate |v| /
/// way.
inline double bristle_after(StandstillLaw law, double z, double speed, double ceiling, double way, double h) {
  const double share = plastic_share(law, z, speed, ceiling),
               rate = share * std::abs(speed) / (ceiling * way);
  if (rate * h < 1e-9) return z + h * speed / way;
  const double tends = speed / way / rate, after = tends + (z - tends) * std::exp(-rate * h);
  return std::clamp(after, -std::max(std::abs(z), ceiling), std::max(std::abs(z), ceiling));
}

/// LuGre's sigma_1 z', in units of the level: about the critical damping of the bristle, decreasing with
/// speed.
inline double lugre_damping(double z_slope, double speed, double way, double level_n, double mass_kg) {
  const double frequency = std::sqrt(level_n / (way * mass_kg));
  constexpr double kFades = 0.01;
  return std::exp(-std::pow(speed / kFades, 2)) * z_slope / frequency;
}

}  // namespace mujoco_truth
