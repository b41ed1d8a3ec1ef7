/// The campaign with one protection switched off. Without arguments, the program tests every protection in
/// turn. A protection is necessary when a run violates an invariant without the protection, and the run of
/// the same hazard, moment and seed violates no invariant with the protection.
///   campaign_mutants [--without NAME] [--seeds N] [--hazard N ...]
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iostream>
#include <map>
#include <optional>
#include <utility>

#include "campaign/report.hpp"
#include "crane/protection.hpp"
#include "crane/supervisor/rules.hpp"

namespace {
std::string switched_off;  // empty: none
}

namespace crane::protection {
inline namespace mutated {
bool enabled(std::string_view rule) noexcept { return switched_off != rule; }
}  // namespace mutated
}  // namespace crane::protection

namespace {

using namespace crane;
using namespace crane::campaign;

/// Hazards that need a protection, and the number of seeds.
struct Need {
  Need(std::string_view rule, std::vector<int> where) : protection{rule}, hazards{std::move(where)} {}
  Need(protection::Protection one, std::vector<int> where)
      : Need{protection::kNames[static_cast<std::size_t>(one)], std::move(where)} {}
  std::string_view protection;
  std::vector<int> hazards;
  std::uint64_t seeds = 12;
};

/// The rules of the supervisor, and the names in protection::kNames.
std::vector<std::string_view> all_protections() {
  std::vector<std::string_view> names;
  for (const auto& rule : supervisor::rules()) names.push_back(rule.name);
  names.insert(names.end(), protection::kNames.begin(), protection::kNames.end());
  return names;
}

std::vector<Need> needs() {
  using enum protection::Protection;
  return {{"supervisor_brake_did_not_close", {24}},
          {"supervisor_relay_did_not_open", {46}},
          {"supervisor_selftest_failed", {34}},
          {"supervisor_foreign_command", {43}},
          {"supervisor_estop_input", {31}},
          {"supervisor_operator_estop", {37}},
          {"supervisor_second_writer", {9, 10}},
          {"supervisor_bridge_latched", {15}},
          {"supervisor_not_homed", {42}},
          {"supervisor_homing_failed", {39}},
          {"supervisor_position_limit", {33}},
          {"supervisor_limit_switch", {32}},
          {"supervisor_overspeed", {15}},
          {"supervisor_brake_closed_itself", {25}},
          {"supervisor_bridge_not_ready", {40}},
          {"supervisor_no_match", {40}},
          {"supervisor_moved_while_arming", {40}},
          {"supervisor_brake_did_not_open", {25}},
          {"supervisor_state_stale", {4}},
          {"supervisor_demand_stale", {1}},
          {"supervisor_demand_invalid", {6}},
          {"supervisor_demand_rate", {7}},
          {"supervisor_overrun", {27}},
          {"supervisor_stopping_envelope", {22}},
          {"supervisor_swing_runaway", {23}},
          {"supervisor_following_error", {20}},
          {"supervisor_swing_sensor", {18}},
          {"supervisor_stop_timeout", {38}},
          {"supervisor_swing_limit", {23}},
          {"supervisor_operator_stop", {37}},
          {"supervisor_operator_disarm", {37}},
          {"supervisor_homed", {39}},
          {"supervisor_idle", {36}},
          {"supervisor_bridge_restarted", {35}},
          {"supervisor_echo", {43}},
          {supervisor_bridge_clock, {47}},
          {gate_range, {44}},
          {gate_rate, {7}},
          {gate_block_outwards, {22}},
          {request_target, {32}},
          {request_id, {32}},
          {reset_edge, {32}},
          {reset_clear_time, {32}},
          {reset_position_doubtful, {35}},
          {reset_swing_zero_doubtful, {35}},
          {arm_fresh_time, {32}},
          {brake_slip, {45}},
          {brake_report, {24}},
          {bridge_second_writer, {9}},
          {bridge_command_stale, {3}},
          {bridge_command_not_finite, {6}},
          {bridge_command_range, {6}},
          {bridge_command_rate, {7}},
          {bridge_not_homed, {39}},
          {bridge_encoder_jump, {15}},
          {bridge_lost_counts, {17}},
          {bridge_position, {41}},
          {bridge_speed, {15}},
          {bridge_swing, {41}},
          {bridge_braked_motion, {41}},
          {bridge_encoder_frozen, {41}},
          {bridge_drive_response, {41}},
          {bridge_latch_is_kept, {15, 41}},
          {bus_checksum, {8}},
          {bus_source, {32}},
          {bus_one_writer, {9}},
          {bus_ledger, {48}}};
}

/// Tests of the protections that no run can prove necessary, because another protection detects the same
/// fault, because the rigs of the campaign have no zones, or because a run has only one stack.
struct Elsewhere {
  std::string_view protection;
  const char* test;
};
/// Two loop topics of one type never have the same writer. A sample on the wrong topic therefore also has a
/// wrong source.
constexpr std::array kElsewhere{
    Elsewhere{"bus_checksum_of_topic", "Intact.IsFalseOnAnotherTopicOfTheSameType"},
    Elsewhere{"supervisor_configuration_differs",
              "AnotherConfiguration.OfTheDemandRemovesPowerInTheSameTick"},
    Elsewhere{"supervisor_sole", "TwoSupervisors.ThatStartTogetherLeaveOneThatTheOperatorCanUse"},
    Elsewhere{"supervisor_zone", "HostileRuns.NeverLeadTheLoadIntoAZone"},
    Elsewhere{"supervisor_zone_ahead", "ZoneStop.OfAFastCraneIsControlledFirst"}};

bool fails(const Result& result) { return result.violations != 0 || result.crashed || !result.prepared; }

/// Runs with all protections; each tuple runs once.
class Sound {
 public:
  explicit Sound(unsigned jobs) : jobs_{jobs} {}
  /// @return true when the run of this tuple violates no invariant
  bool passes(const Tuple& tuple) { return passes_.at(tuple); }
  void make(const std::vector<Tuple>& wanted) {
    std::vector<Tuple> missing;
    for (const auto& tuple : wanted)
      if (!passes_.contains(tuple)) missing.push_back(tuple);
    const auto without = std::exchange(switched_off, std::string{});
    run_all(missing, jobs_, [this](const Result& result) { passes_[result.tuple] = !fails(result); });
    switched_off = without;
  }

 private:
  unsigned jobs_;
  std::map<Tuple, bool> passes_;
};

/// @return the first run that violates an invariant only without the protection
std::optional<Result> caught_by(const Need& need, std::uint64_t first_seed, std::uint64_t most_seeds,
                                unsigned jobs, Sound& sound) {
  for (std::uint64_t seed = 0; seed < most_seeds; seed += need.seeds) {
    const auto wanted = tuples(
        {.hazards = need.hazards, .moments = {}, .first_seed = first_seed + seed, .seeds = need.seeds});
    sound.make(wanted);
    std::optional<Result> caught;
    run_all(wanted, jobs, [&](const Result& result) {
      if (fails(result) && sound.passes(result.tuple) && (!caught || result.tuple < caught->tuple))
        caught = result;
    });
    if (caught) return caught;
  }
  return std::nullopt;
}

int check_all(std::uint64_t first_seed, std::uint64_t most_seeds, unsigned jobs) {
  Sound sound{jobs};
  std::size_t caught = 0;
  const auto all = needs();
  const auto declared = all_protections();
  for (const auto& need : all) {
    switched_off = need.protection;
    const auto result = caught_by(need, first_seed, most_seeds, jobs, sound);
    if (result) ++caught;
    std::cout << need.protection << ": " << (result ? describe(*result) : std::string{"NOT CAUGHT"})
              << std::endl;
  }
  const auto elsewhere = [](std::string_view name) {
    return std::ranges::any_of(kElsewhere, [&](const Elsewhere& one) { return one.protection == name; });
  };
  for (const Elsewhere& one : kElsewhere) std::cout << one.protection << ": " << one.test << '\n';
  for (const auto name : declared)
    if (!elsewhere(name) && std::ranges::find(all, name, &Need::protection) == all.end())
      std::cout << name << ": NO HAZARD\n";
  std::cout << caught << " of " << all.size() << " protections are needed by the campaign, "
            << kElsewhere.size() << " by a test; " << declared.size() << " are declared\n";
  return caught + kElsewhere.size() == declared.size() ? 0 : 1;
}

int run_campaign(const Selection& selection, unsigned jobs) {
  Table table;
  run_all(tuples(selection), jobs, [&](const Result& result) { table.add(result); });
  std::cout << table.text();
  return table.violations() == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  spdlog::set_level(spdlog::level::off);
  CLI::App app{"The campaign with one protection switched off"};
  std::string without;
  std::vector<int> hazards;
  std::uint64_t seeds = 24, seed = 0;
  std::string moment;
  unsigned jobs = 2;
  app.add_option("--without", without, "name of a protection; none: every one in turn");
  app.add_option("--hazard", hazards, "with --without: these hazards only");
  app.add_option("--moment", moment, "with --hazard: this moment only");
  app.add_option("--first-seed", seed, "first seed");
  app.add_option("--seeds", seeds, "seeds, at most");
  app.add_option("--jobs", jobs, "processes that work at the same time");
  CLI11_PARSE(app, argc, argv);
  if (without.empty()) return check_all(seed, seeds, jobs);
  const auto names = all_protections();
  if (std::ranges::find(names, without) == names.end()) {
    std::cerr << without << " is no protection\n";
    return 2;
  }
  switched_off = without;
  Selection selection{.hazards = hazards, .moments = {}, .first_seed = seed, .seeds = seeds};
  if (const auto named = moment_named(moment)) selection.moments = {*named};
  return run_campaign(selection, jobs);
}
