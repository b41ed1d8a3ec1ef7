#include "crane/supervisor/modes.hpp"

#include <algorithm>
#include <cmath>

namespace crane::supervisor {
namespace {

// Maintenance limits the stick to the micro-speed of `crane jog`. Chosen: a quarter of max_speed. On the
// tower crane this is 0.375 m/s, above the 0.25 m/s of manual reduced speed in ISO 10218-1. With any law, a
// step of kShortStep_m reaches at most 0.16 m/s (tests/jog/operating_modes_test.cpp prints the speeds).
constexpr std::array<ModeRule, kModes> kModeRules{{
    {"semi_automatic", true, Moves::all, true, 1, 1,
     "an operator drives with the stick or requests moves; no restriction"},
    {"automatic", false, Moves::all, true, 1, 1, "a program requests moves; the stick is refused"},
    {"manual", true, Moves::none, false, 1, 1, "an operator drives with the stick; moves are refused"},
    {"maintenance", true, Moves::short_steps, false, 0.1, 0.25,
     "adjustment and test of the crane: stick and short moves, at reduced speed"},
}};

std::string in_words(Moves moves) {
  if (moves == Moves::none) return "refused";
  return moves == Moves::all ? "permitted"
                             : "at most " + std::to_string(std::lround(1e3 * kShortStep_m)) + " mm";
}

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

std::string stick_in_words(const ModeRule& rule) {
  if (!rule.stick) return "refused";
  return rule.stick_share < 1 ? "limited to " + percent(rule.stick_share) + " deflection" : "permitted";
}

}  // namespace

const ModeRule& rule_of(Mode mode) noexcept { return kModeRules[static_cast<std::size_t>(mode)]; }

std::optional<Mode> find_mode(std::string_view name) noexcept {
  const auto* found = std::ranges::find(kModeRules, name, &ModeRule::name);
  if (found == kModeRules.end()) return std::nullopt;
  return static_cast<Mode>(found - kModeRules.begin());
}

std::string mode_names() {
  std::string names;
  for (std::size_t i = 0; i < kModes; ++i)
    names += (i == 0 ? "" : i + 1 == kModes ? " or " : ", ") + std::string{kModeRules[i].name};
  return names;
}

PerAxis limited_stick(Mode mode, const PerAxis& deflection) noexcept {
  const double most = rule_of(mode).stick_share;
  PerAxis limited{};
  for (std::size_t i = 0; i < kAxes; ++i) limited[i] = std::clamp(deflection[i], -most, most);
  return limited;
}

std::string mode_table() {
  std::string table =
      "| mode | purpose | stick | moves | excitations | largest speed |\n|---|---|---|---|---|---|\n";
  for (const ModeRule& rule : kModeRules)
    for (const auto& cell :
         {"| `" + std::string{rule.name} + "`", std::string{rule.purpose}, stick_in_words(rule),
          in_words(rule.moves), std::string{rule.excitation ? "permitted" : "refused"},
          percent(rule.speed_share) + " of `max_speed` |\n"})
      table += cell + (cell.ends_with('\n') ? "" : " | ");
  return table;
}

}  // namespace crane::supervisor
