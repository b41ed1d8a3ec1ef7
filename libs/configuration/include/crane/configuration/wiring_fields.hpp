#pragma once
/// Tables of the fields of [encoder.NAME] and [wiring], which depend on the hardware board.
#include <array>

#include "crane/configuration/rig.hpp"

namespace crane::configuration {

using fields::Field;
using fields::Presence;
using fields::Quantity;
using fields::Range;

inline constexpr Range kChannels = Range::closed(0, 7);     ///< boards have 8 counters and 8 analog outputs
inline constexpr Range kInputs = Range::closed(0, 15);      ///< ports A and B
inline constexpr Range kOutputs = Range::closed(16, 31);    ///< ports C and D
inline constexpr Range kSubdevices = Range::closed(0, 63);  ///< of a comedi board

inline constexpr std::array<Field<Encoder>, 3> kEncoderFields{{
    {.key = "channel",
     .member = &Encoder::channel,
     .range = kChannels,
     .meaning = "counter of the board; each encoder has its own",
     .presence = Presence::required},
    {.key = "counts_per",
     .member = &Encoder::counts_per_unit,
     .range = Range::above(0, 1e9),
     .unit = "counts",
     .meaning = "counts per unit of the axis, including lines, quadrature and gear",
     .presence = Presence::required,
     .quantity = Quantity::position},
    {.key = "sign",
     .member = &Encoder::sign,
     .range = Range::closed(-1, 1),
     .meaning = "1 or -1: direction of counting"},
}};

/// For encoders of swing only.
inline constexpr std::array<Field<Encoder>, 1> kRestFields{{
    {.key = "rest_angle_rad",
     .member = &Encoder::rest_angle_rad,
     .range = Range::closed(-0.5, 0.5),
     .unit = "rad",
     .meaning = "swing encoders only: angle that the encoder shows while the load hangs at rest; "
                "`crane/state` contains the angle without it"},
}};

inline constexpr std::array<Field<Wiring>, 10> kWiringFields{{
    {.key = "base_address",
     .member = &Wiring::base_address,
     .range = Range::closed(0x200, 0x3E0),
     .meaning = "I/O address that the jumpers of a Servo-to-Go card set: 0x200 + 0x20 n",
     .default_text = "0x200"},
    {.key = "device", .member = &Wiring::device, .meaning = "device file of a comedi board"},
    {.key = "counter_subdevice",
     .member = &Wiring::counter_subdevice,
     .range = kSubdevices,
     .meaning =
         "subdevice of the counters of a comedi board; the four subdevices differ, and their defaults are "
         "those of an s626"},
    {.key = "analog_output_subdevice",
     .member = &Wiring::analog_output_subdevice,
     .range = kSubdevices,
     .meaning = "subdevice of the analog outputs"},
    {.key = "input_subdevice",
     .member = &Wiring::input_subdevice,
     .range = kSubdevices,
     .meaning = "subdevice of the digital inputs"},
    {.key = "output_subdevice",
     .member = &Wiring::output_subdevice,
     .range = kSubdevices,
     .meaning = "subdevice of the digital outputs"},
    {.key = "estop_input",
     .member = &Wiring::estop_input,
     .range = kInputs,
     .meaning = "contact that is open while the emergency stop is pressed"},
    {.key = "relay_closed_input",
     .member = &Wiring::relay_closed_input,
     .range = kInputs,
     .meaning = "contact that is closed while the watchdog relay is closed"},
    {.key = "watchdog_output",
     .member = &Wiring::watchdog_output,
     .range = kOutputs,
     .meaning = "watchdog output of the bridge; in normal operation it changes every tick"},
    {.key = "relay_timeout_s",
     .member = &Wiring::relay_timeout_s,
     .range = Range::above(0, 1),
     .unit = "s",
     .meaning = "the watchdog relay opens when the watchdog output is constant for longer than this"},
}};

inline constexpr std::array<Field<DriveLines>, 5> kDriveLineFields{{
    {.key = "limit_low_input",
     .member = &DriveLines::limit_low_input,
     .range = kInputs,
     .meaning = "contact that is open while the axis is at its low limit switch",
     .default_text = "1; 3; 5"},
    {.key = "limit_high_input",
     .member = &DriveLines::limit_high_input,
     .range = kInputs,
     .meaning = "contact that is open while the axis is at its high limit switch",
     .default_text = "2; 4; 6"},
    {.key = "brake_closed_input",
     .member = &DriveLines::brake_closed_input,
     .range = kInputs,
     .meaning = "contact that is closed while the brake is closed",
     .default_text = "7; 8; 9"},
    {.key = "brake_release_output",
     .member = &DriveLines::brake_release_output,
     .range = kOutputs,
     .meaning = "output that supplies the brake with 24 V, if the relay is closed; the brake then opens",
     .default_text = "16; 17; 18"},
    {.key = "mark_input",
     .member = &DriveLines::mark_input,
     .range = Range::closed(-1, kInputs.high),
     .meaning = "contact that is closed while the axis is below its mark; -1: not wired"},
}};

}  // namespace crane::configuration
