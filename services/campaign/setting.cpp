#include "campaign/setting.hpp"

#include <algorithm>
#include <optional>

#include "stack/data_files.hpp"

namespace crane::campaign {
namespace {

struct Choice {
  const char* rig;
  const char* controller;
  std::array<double, 3> start;   ///< m, rad, m of cable
  std::array<double, 3> target;  ///< m, rad, m of cable; an axis with target = start does not move
  std::size_t axis;
};

constexpr const char* kTower = "virginia_tech_tower";
constexpr const char* kGantry = "gantry";

/// Eleven controllers, two rigs, each axis alone and with others, both directions.
constexpr std::array<Choice, kSettings> kChoices{{
    {kTower, "gain_scheduling_partial", {0.3, 0, 1}, {1.05, 0, 1}, 0},
    {kGantry, "gain_scheduling_full", {0.5, 0, 1.5}, {1.7, 0, 1.5}, 0},
    {kTower, "anti_swing_pd", {0.6, 0, 1}, {0.6, 1.57, 1}, 1},
    {kGantry, "delayed_1", {0.5, 0, 1.5}, {2.2, 0, 1.5}, 0},
    {kTower, "delayed_2", {0.3, 0, 1}, {1.05, 1.57, 1}, 0},
    {kGantry, "fuzzy_generated", {0.6, 0, 1.6}, {1.6, 0, 0.8}, 2},
    {kTower, "fuzzy_printed", {0.8, 0.8, 1}, {0.8, -1.57, 1}, 1},
    {kTower, "none", {0.5, 0, 1.2}, {0.5, 0, 0.6}, 2},
    {kGantry, "gain_scheduling_partial", {2.2, 0, 1.5}, {0.8, 0, 1.5}, 0},
    {kTower, "delayed_1_optimised", {1.1, 0, 0.8}, {0.4, 0, 1.3}, 0},
    {kGantry, "delayed_2_optimised", {2.4, 0, 1.2}, {0.9, 0, 1.2}, 0},
    {kTower, "anti_swing_pd_optimised", {0.4, 0, 1}, {1.0, 1.2, 0.7}, 1},
}};

constexpr std::array<std::string_view, kMoments> kMomentNames{
    "armed_idle", "brake_release", "peak_acceleration", "cruise", "limit", "stop"};

/// Farthest permitted target in the direction of the move.
double farthest(const configuration::Drive& drive, double start, double target) {
  constexpr double kRounding = 1e-6;
  return target > start ? drive.high_limit - drive.soft_margin - kRounding
                        : drive.low_limit + drive.soft_margin + kRounding;
}

}  // namespace

std::string_view name_of(Moment moment) noexcept { return kMomentNames[static_cast<std::size_t>(moment)]; }

std::optional<Moment> moment_named(std::string_view name) noexcept {
  const auto found = std::ranges::find(kMomentNames, name);
  if (found == kMomentNames.end()) return std::nullopt;
  return static_cast<Moment>(found - kMomentNames.begin());
}

Setting setting(std::uint64_t number, Moment moment) {
  const Choice& choice = kChoices.at(number);
  Setting made;
  made.configured = configuration::load_rig(stack::find_rig(choice.rig));
  made.configured.start.position = choice.start;
  made.controller = control::find_controller(choice.controller);
  made.axis = choice.axis;
  for (std::size_t i = 0; i < made.target.size(); ++i) {
    made.selected[i] = choice.target[i] != choice.start[i];
    made.target[i] = choice.target[i];
  }
  if (moment == Moment::limit)
    made.target[made.axis] =
        farthest(made.configured.drives[made.axis], choice.start[made.axis], choice.target[made.axis]);
  made.actual = made.configured;
  return made;
}

}  // namespace crane::campaign
