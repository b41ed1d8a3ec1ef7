#include "score/hidden_set.hpp"

namespace crane::diagnosis::score {

const std::vector<HiddenSet> kFoundAlone{{"command_delay", "trolley", "drive_axis"},
                                         {"command_delay", "trolley", "drive_axis", 3, 11},
                                         {"coulomb_friction", "trolley", "drive_axis", -1},
                                         {"viscous_friction", "trolley", "drive_axis"},
                                         {"stribeck_friction", "trolley", "drive_axis"},
                                         {"motor_gain", "trolley", "drive_axis"},
                                         {"actuator_lag", "trolley", "drive_axis"},
                                         {"payload_mass", "", "gantry"},
                                         {"load_linear_drag", "", "tower"},
                                         {"load_quadratic_drag", "", "tower"},
                                         {"swing_pivot_friction", "", "tower"},
                                         {"jib_tilt", "", "tower"},
                                         {"swing_scale", "radial", "tower"},
                                         {"swing_misalignment", "", "tower"},
                                         {"cable_length", "", "tower", -1},
                                         {"position_scale", "trolley", "drive_axis"},
                                         {"position_drift", "trolley", "drive_axis", 3},
                                         {"direction_asymmetry", "trolley", "drive_axis"},
                                         {"position_dependent_friction", "trolley", "drive_axis"},
                                         {"jib_flexibility", "", "tower"},
                                         {"double_pendulum", "", "tower"},
                                         {"backlash", "trolley", "tower"},
                                         {"backlash", "slew", "tower"},
                                         {"torque_ripple", "trolley", "drive_axis"},
                                         {"swing_moving_average", "", "tower"}};

// An elastic cable is named as a longer cable, because no sensor measures its vertical oscillation. A swing
// offset is named as a tilted jib: both differ by a force on the trolley of 13 mV, less than the accuracy of
// its friction.
const std::vector<HiddenSet> kNotFoundYet{{"cable_elasticity", "", "tower"},
                                          {"swing_offset", "radial", "tower"}};

// Confounded: gain and scale of the encoder without a load; delay and lag beside Coulomb friction.
const std::vector<HiddenSet> kWithoutTerm{{"position_drift", "trolley", "drive_axis", 3},
                                          {"stribeck_friction", "trolley", "drive_axis"},
                                          {"position_dependent_friction", "trolley", "drive_axis"},
                                          {"viscous_friction", "trolley", "drive_axis"},
                                          {"direction_asymmetry", "trolley", "drive_axis"}};

const std::vector<HiddenSet> kSwitchedOff{{"command_delay", "trolley", "drive_axis", 0, 8},
                                          {"swing_delay", "", "tower", 0},
                                          {"payload_mass", "", "gantry", 0, 9}};

// A drifting gain is visible on a rig without friction.
const std::vector<HiddenSet> kOutside{
    {"magnetic_detent", "trolley", "drive_axis"},  {"gain_drift", "trolley", "gantry"},
    {"hysteretic_force", "trolley", "drive_axis"}, {"periodic_force", "trolley", "drive_axis"},
    {"load_periodic_force", "", "gantry"},         {"slew_crosstalk", "trolley", "tower"},
    {"sticking_brake", "trolley", "drive_axis"}};

// Confounded: dead zone and Coulomb friction while the axis moves; offset and asymmetric friction; delay and
// moving average of the swing at one cable length.
const std::vector<HiddenSet> kAlike{{"command_dead_zone", "trolley", "drive_axis"},
                                    {"command_offset", "trolley", "drive_axis"},
                                    {"steady_wind", "", "tower"},
                                    {"swing_delay", "", "tower"}};

const std::vector<HiddenPair> kPairs{
    {{"command_delay", "trolley", "drive_axis"}, {"viscous_friction", "trolley", "drive_axis"}}};

const std::vector<HiddenSet> kFreshCauses{{"command_delay", "trolley", "drive_axis"},
                                          {"viscous_friction", "trolley", "drive_axis"},
                                          {"stribeck_friction", "trolley", "drive_axis"},
                                          {"position_scale", "trolley", "drive_axis"},
                                          {"motor_gain", "trolley", "drive_axis"},
                                          {"actuator_lag", "trolley", "drive_axis"},
                                          {"", "", "drive_axis"}};

}  // namespace crane::diagnosis::score
