/// The recommendation must hold on every rig that the identification cannot distinguish from its estimate.
#include "tuning/recommend.hpp"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "crane/plant/coordinates.hpp"
#include "hidden_rig.hpp"
#include "stack/data_files.hpp"
#include "tuning/drawn_rigs.hpp"

namespace crane::tuning {
namespace {

/// True parameters of a hidden gantry as identified values with relative standard errors of 1 %.
Identified identified_gantry(const HiddenRig& hidden) {
  const auto value = [](double truth) { return Value{truth, 0.01 * std::abs(truth)}; };
  const auto& drive = hidden.drives[plant::kTrolley];
  Identified identified{.cable_m = value(hidden.cable_m),
                        .second_mode = {},
                        .rest_angle_rad = {value(hidden.rest_angle_rad[0]), Value{}},
                        .load_mass_kg = value(hidden.load_mass_kg),
                        .drives = {}};
  identified.drives[plant::kTrolley] = {.gain = value(drive.gain),
                                        .coulomb_positive_v = value(drive.coulomb_positive_v),
                                        .coulomb_negative_v = value(drive.coulomb_negative_v),
                                        .viscous_positive_vspm = value(drive.viscous_positive_vspm),
                                        .viscous_negative_vspm = value(drive.viscous_negative_vspm),
                                        .delay_s = {0, 0.001}};  // half of the draws would be negative
  return identified;
}

TEST(DrawnRigs, HaveTheStandardErrorsAndKeepTheBoundsOfTheModel) {
  constexpr std::size_t kCount = 1000;
  const auto hidden = hidden_rig(1);
  const auto identified = identified_gantry(hidden);
  const auto rigs = drawn_rigs(hidden.ideal, identified, kCount, 7);
  double sum = 0, squares = 0;
  std::size_t delayed = 0;
  for (const auto& rig : rigs) {
    const double score =
        (rig.plant.load_mass_kg - identified.load_mass_kg.value) / identified.load_mass_kg.standard_error;
    sum += score, squares += score * score;
    for (const auto& term : rig.terms)
      if (term.name == "command_delay") {
        ++delayed;
        EXPECT_GT(term.parameters.at("delay_s"), 0);
      }
    EXPECT_EQ(rig.encoders[plant::kSwingRadial].rest_angle_rad, identified.rest_angle_rad[0].value);
  }
  // Five standard errors of mean, variance and share of 1000 draws: 5 / sqrt(n), 5 sqrt(2 / n), 2.5 /
  // sqrt(n).
  const double n = kCount;
  EXPECT_NEAR(sum / n, 0, 5 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1, 5 * std::sqrt(2 / n));
  EXPECT_NEAR(static_cast<double>(delayed) / n, 0.5, 2.5 / std::sqrt(n));
  const auto again = drawn_rigs(hidden.ideal, identified, 1, 7);
  EXPECT_EQ(configuration::to_toml(again.front()), configuration::to_toml(rigs.front()));
}

TEST(Recommend, NeverRecommendsALawThatDoesNotSettleOnADrawnRig) {
  spdlog::set_level(spdlog::level::off);
  const auto hidden = hidden_rig(1);
  const std::vector<std::filesystem::path> files{stack::find_scenario("maneuver_1")};
  const auto maneuvers = maneuvers_for(hidden.ideal, files);
  ASSERT_EQ(maneuvers.size(), 1U);
  const std::vector<Candidate> list{
      {.controller = "gain_scheduling_full", .gains = {{"full_state_forward_gain_vpm", 8}}}};
  std::vector<configuration::Rig> drawn{hidden.ideal};
  const auto search = [&] {
    return recommend({.truth = hidden.ideal,
                      .rig = hidden.ideal,
                      .drawn = drawn,
                      .maneuvers = maneuvers,
                      .candidates = list});
  };
  const auto certain = search();
  ASSERT_TRUE(certain.winner);
  const auto& predicted = *certain.entries.front().predicted;
  EXPECT_EQ(predicted.least_s, predicted.largest_s);
  EXPECT_EQ(counts(certain), (std::array<std::size_t, 3>{1, 1, 1}));
  auto slow = hidden.ideal;
  const auto delay = std::ranges::find(slow.terms, "command_delay", &plant::TermSetting::name);
  ASSERT_NE(delay, slow.terms.end());
  delay->parameters["delay_s"] = 0.2;  // far beyond the delay margin
  drawn.push_back(slow);
  const auto uncertain = search();
  EXPECT_FALSE(uncertain.winner);
  EXPECT_EQ(counts(uncertain), (std::array<std::size_t, 3>{1, 1, 0}));
}

}  // namespace
}  // namespace crane::tuning
