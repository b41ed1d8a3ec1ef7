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
    {"command_stale", "no valid command arrived within stale_after_s",
     "check whether the supervisor has ended or hangs, then `crane reset`"},
    {"command_not_finite", "a voltage of a command was NaN or infinite",
     "restart the supervisor, then `crane reset`"},
    {"command_range", "a voltage of a command exceeded volt_limit_v",
     "restart the supervisor, then `crane reset`"},
    {"command_rate", "a voltage of a command rose faster than volt_rate_limit_vps",
     "restart the supervisor, then `crane reset`"},
    {"position", "an axis could not have stopped before its hard limit",
     "bring the axis inside its limits by hand, then `crane reset`"},
    {"speed", "an axis was faster than 1.1 times max_speed", "check drive and encoder, then `crane reset`"},
    {"swing", "the swing exceeded 1.5 times swing_limit_rad",
     "let the load come to rest, then `crane reset`"},
    {"encoder_jump",
     "an encoder changed in one tick by more than any motion can explain: a position is unknown",
     "check the cable of the encoder, then `crane reset` and `crane home`; an axis without a mark: move it "
     "to its start position by hand, then restart the bridge"},
    {"lost_counts",
     "a limit switch or mark operated far from its position: counts are lost, a position is unknown",
     "check encoder and switch, then `crane reset` and `crane home`; an axis without a mark: move it to its "
     "start position by hand, then restart the bridge"},
    {"braked_motion", "an axis moved although its brake was closed",
     "repair the brake, then restart the bridge"},
    {"encoder_frozen", "the voltage of a drive must have moved its axis, but the encoder did not change",
     "check encoder, brake and amplifier, then `crane reset`"},
    {"drive_response", "an axis gained speed that no command explains",
     "check converter, amplifier and signs, then `crane reset`"},
    {"not_homed",
     "an axis with unknown position was released without homing, or exceeded the voltage or speed of homing",
     "`crane reset`, then `crane home`"},
    {"second_writer", "crane/command has a second writer",
     "end the other program, then `crane reset`; a hanging earlier supervisor must be ended, too"},
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
