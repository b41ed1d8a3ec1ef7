#include "tuning/drawn_rigs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "crane/plant/coordinates.hpp"

namespace crane::tuning {
namespace {

class Normal {
 public:
  explicit Normal(std::uint64_t seed) : engine_{seed} {}
  /// Standard normal value (Box-Muller), because std::normal_distribution differs between libraries.
  double operator()() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  double uniform() { return static_cast<double>(engine_() >> 11U) / 9007199254740992.0; }  // 2^53

  std::mt19937_64 engine_;
};

Identified drawn(Identified values, Normal& normal) {
  const auto draw = [&](Value& value, double low) {
    value.value = std::max(low, value.value + value.standard_error * normal());
  };
  constexpr double kNoBound = -std::numeric_limits<double>::infinity();
  // Cable, load and gain must stay positive: a draw is at least half of the estimate.
  const auto draw_positive = [&](Value& value) { draw(value, value.value / 2); };
  draw_positive(values.cable_m);
  draw_positive(values.load_mass_kg);
  for (auto& angle : values.rest_angle_rad) draw(angle, kNoBound);
  if (auto& second = values.second_mode) {
    draw_positive(second->lower_share);
    second->lower_share.value = std::min(second->lower_share.value, largest_lower_share());
    draw_positive(second->lower_length_m);
    draw(second->hook_raised_m, 0);
  }
  for (auto& drive : values.drives) {
    if (!drive) continue;
    draw_positive(drive->gain);
    for (Value* value : {&drive->coulomb_positive_v, &drive->coulomb_negative_v,
                         &drive->viscous_positive_vspm, &drive->viscous_negative_vspm, &drive->delay_s})
      draw(*value, 0);
  }
  return values;
}

}  // namespace

std::vector<configuration::Rig> drawn_rigs(const configuration::Rig& tuned, const Identified& identified,
                                           std::size_t count, std::uint64_t seed) {
  Normal normal{seed};
  std::vector<configuration::Rig> rigs;
  for (std::size_t i = 0; i < count; ++i) {
    const auto values = drawn(identified, normal);
    auto rig = with_identified(tuned, values);
    for (const std::size_t swing : {plant::kSwingRadial, plant::kSwingTangential}) {
      if (!rig.measures(swing)) continue;
      const std::size_t side = swing - plant::kSwingRadial;
      const double estimate = identified.rest_angle_rad[side].value;
      rig.encoders[swing].rest_angle_rad = estimate;
      rig.terms.push_back({"swing_offset",
                           side == 0 ? "radial" : "tangential",
                           {{"offset_rad", values.rest_angle_rad[side].value - estimate}}});
    }
    rigs.push_back(std::move(rig));
  }
  return rigs;
}

}  // namespace crane::tuning
