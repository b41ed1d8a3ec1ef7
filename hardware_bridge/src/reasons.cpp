#include <array>

#include "crane/bridge/last_line.hpp"

namespace crane::bridge {
namespace {

struct Texts {
  std::string_view name, explanation, remedy;
};

/// In the order of Reason.
constexpr std::array<Texts, kReasons> kTexts{{
    {"none", "", ""},
    {"command_stale", "commands stopped coming", "look for a dead or hung supervisor, then `crane reset`"},
    {"command_not_finite", "a command was not a number", "restart the supervisor, then `crane reset`"},
    {"command_range", "a command was beyond the drive's limit", "restart the supervisor, then `crane reset`"},
    {"command_rate", "a command rose faster than volt_rate_limit_vps",
     "restart the supervisor, then `crane reset`"},
    {"position", "an axis would not have stopped before its hard limit",
     "bring the axis inside its limits by hand, then `crane reset`"},
    {"speed", "an axis was faster than its max_speed", "check drive and encoder, then `crane reset`"},
    {"swing", "the load swung farther than any maneuver lets it",
     "let the load come to rest, then `crane reset`"},
    {"encoder_jump", "an encoder jumped: positions are unknown",
     "check its cable, then `crane home`; without a mark: crane to its start position, restart the bridge"},
    {"lost_counts", "a limit switch closed where the encoder says there is none: positions are unknown",
     "check encoder and switch, then `crane home`; without a mark: crane to its start position, restart the "
     "bridge"},
    {"braked_motion", "an axis moved although its brake was closed",
     "repair the brake, then restart the bridge"},
    {"encoder_frozen", "a drive pushed for 0.1 s and its encoder stood still",
     "check encoder, brake and amplifier, then `crane reset`"},
    {"drive_response", "an axis gained speed that no command explains",
     "check converter, amplifier and signs, then `crane reset`"},
    {"not_homed", "an axis whose position is not known was to move, or moved, faster than it may creep",
     "`crane reset`, then `crane home`"},
    {"second_writer", "crane/command has a second writer",
     "end the other program, then `crane reset`; where the supervisor was started anew beside a hung one, "
     "end "
     "the hung one"},
}};

const Texts& texts_of(Reason reason) { return kTexts[static_cast<std::size_t>(reason)]; }

}  // namespace

std::string_view name_of(Reason reason) noexcept { return texts_of(reason).name; }
std::string_view explanation_of(Reason reason) noexcept { return texts_of(reason).explanation; }
std::string_view remedy_for(Reason reason) noexcept { return texts_of(reason).remedy; }

bool is_final(Reason reason) noexcept {
  return reason == Reason::encoder_jump || reason == Reason::lost_counts || reason == Reason::braked_motion;
}

}  // namespace crane::bridge
