#pragma once
/// Tables of the fields of a rig file, one per section. plant/parameter_fields.hpp has the table of [plant],
/// control/design_fields.hpp that of [controller]. control/drive_limit_fields.hpp and
/// control/operating_limits.hpp have the limits, which the supervisor checks as well. Equation numbers:
/// H. M. Omar, Control of Gantry and Tower Cranes.
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/configuration/wiring_fields.hpp"
#include "crane/control/design_fields.hpp"
#include "crane/control/drive_limit_fields.hpp"
#include "crane/control/operating_limits.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/plant/parameter_fields.hpp"

namespace crane::configuration {

using fields::AxisSet;
using fields::Choice;
using fields::Element;
using fields::Field;
using fields::Presence;
using fields::Quantity;
using fields::Range;

/// Limits of a trajectory: within this range, all times of a trajectory are finite and positive.
inline constexpr Range kPlanned = Range::closed(1e-6, 1e6);

[[nodiscard]] std::vector<std::string> board_names();
[[nodiscard]] std::vector<std::string> controller_names();
/// Index of `name`. @pre `names` contains it
[[nodiscard]] std::size_t place_of(const std::string& name, const std::vector<std::string>& names);

inline constexpr std::array<Field<Rig>, 4> kRigFields{{
    {.key = "name",
     .member = &Rig::name,
     .meaning = "name of the rig, not empty",
     .presence = Presence::required},
    {.key = "kind",
     .member = Choice<Rig>{[] {
                             return std::vector<std::string>{"tower", "gantry", "drive_axis", "pendulum"};
                           },
                           [](const Rig& rig) { return static_cast<std::size_t>(rig.kind); },
                           [](Rig& rig, std::size_t i) { rig.kind = static_cast<RigKind>(i); }},
     .meaning = "type of crane, see below",
     .presence = Presence::required},
    {.key = "period_s",
     .member = &Rig::period_s,
     .range = plant::kPeriods,
     .unit = "s",
     .meaning = "period of the control loop (one tick); in real time at least 0.001"},
    {.key = "board",
     .member = Choice<Rig>{board_names, [](const Rig& rig) { return place_of(rig.board, board_names()); },
                           [](Rig& rig, std::size_t i) { rig.board = board_names()[i]; }},
     .meaning = "hardware board ([`hardware.md`](hardware.md)); the simulated plant ignores it"},
}};

inline constexpr std::array<Field<Drive>, 5> kDriveFields{{
    {.key = "dac_channel",
     .member = &Drive::dac_channel,
     .range = kChannels,
     .meaning = "analog output; each drive has its own",
     .presence = Presence::required},
    {.key = "sign",
     .member = &Drive::sign,
     .range = Range::closed(-1, 1),
     .meaning = "1 or -1: direction of motion for a positive voltage; the bridge applies it, so that the "
                "voltages of all topics are positive outward"},
    {.key = "reference_speed",
     .member = &Drive::reference_speed,
     .range = kPlanned,
     .meaning = "V_max of planned moves (3.43), at most `max_speed`",
     .presence = Presence::required,
     .quantity = Quantity::speed},
    {.key = "reference_acceleration",
     .member = &Drive::reference_acceleration,
     .range = kPlanned,
     .meaning = "a_max of planned moves (3.43)",
     .presence = Presence::required,
     .quantity = Quantity::acceleration},
    // The default jerk reaches the full acceleration within 0.1 s.
    {.key = "reference_jerk",
     .member = &Drive::reference_jerk,
     .range = kPlanned,
     .meaning = "largest jerk of planned moves with `trajectory = \"s_curve\"`",
     .quantity = Quantity::jerk,
     .default_text = "10/s times `reference_acceleration`",
     .derived = [](const Drive& drive) { return 10 * drive.reference_acceleration; }},
}};

/// For encoders of drives only.
inline constexpr std::array<Field<Drive>, 1> kZeroFields{{
    {.key = "zero",
     .member = Choice<Drive>{[] {
                               return std::vector<std::string>{"start", "absolute", "homing"};
                             },
                             [](const Drive& drive) { return static_cast<std::size_t>(drive.zero); },
                             [](Drive& drive, std::size_t i) { drive.zero = static_cast<control::Zero>(i); }},
     .meaning =
         "origin of the position. `start`: the axis is at the position in `[start]` when the bridge starts. "
         "`absolute`: the encoder is absolute (boards with incremental counters refuse it). `homing`: the "
         "position is unknown until the axis has found its mark"},
}};

inline constexpr std::array<Field<control::Homing>, 1> kMarkFields{{
    {.key = "mark",
     .member = Choice<control::Homing>{
         [] {
           return std::vector<std::string>{"limit_low", "limit_high", "input"};
         },
         [](const control::Homing& homing) { return static_cast<std::size_t>(homing.mark); },
         [](control::Homing& homing, std::size_t i) { homing.mark = static_cast<control::Mark>(i); }},
     .meaning =
         "homing mark: a limit switch, or (`input`) the contact `mark_input` of `[wiring.NAME]`, which is "
         "closed while the axis is below `position`",
     .presence = Presence::required},
}};

inline constexpr std::array<Field<Sensing>, 3> kSensingFields{{
    {.key = "swing_filter_ratio",
     .member = &Sensing::swing_filter_ratio,
     .range = {0, 0.5, true, false},
     .meaning = "cut-off frequency / sampling frequency of the Butterworth filter; 0: no filter"},
    {.key = "filter_speed",
     .member = AxisSet<Sensing>{&Sensing::filter_speed},
     .meaning = "axes whose position is filtered before it is differentiated",
     .default_text = "`[\"slew\"]`"},
    {.key = "filter_swing_angle",
     .member = &Sensing::filter_swing_angle,
     .meaning = "true: `crane/state` contains the filtered swing angles (effect: `docs/analysis.md`)"},
}};

inline constexpr std::array<Field<Start>, 6> kStartFields{{
    {.key = plant::kCoordinates[plant::kTrolley].column,
     .member = Element<Start>{&Start::position, plant::kTrolley},
     .range = plant::kPositions,
     .unit = "m",
     .meaning = "inside the limits of the drive",
     .default_text = "0.25, without a trolley drive 0"},
    {.key = plant::kCoordinates[plant::kSlew].column,
     .member = Element<Start>{&Start::position, plant::kSlew},
     .range = plant::kPositions,
     .unit = "rad",
     .meaning = "inside the limits of the drive"},
    {.key = plant::kCoordinates[plant::kHoist].column,
     .member = Element<Start>{&Start::position, plant::kHoist},
     .range = plant::kCableLengths,
     .unit = "m",
     .meaning = "inside the limits of the drive"},
    {.key = "cable_length_offset_m",
     .member = &Start::cable_length_offset_m,
     .range = plant::kPositions,
     .unit = "m",
     .meaning = "true minus measured cable length in the simulated plant and in the twin; the load hangs at "
                "the true length; above -`cable_length_m`"},
    {.key = plant::kCoordinates[plant::kSwingRadial].column,
     .member = &Start::swing_radial_rad,
     .range = plant::kSwingAngles,
     .unit = "rad",
     .meaning = "positive: load towards the tower"},
    {.key = plant::kCoordinates[plant::kSwingTangential].column,
     .member = &Start::swing_tangential_rad,
     .range = plant::kSwingAngles,
     .unit = "rad",
     .meaning = "positive: load ahead in the direction of positive slew"},
}};

inline constexpr std::array<Field<Rig>, 1> kControllerFields{{
    {.key = "name",
     .member = Choice<Rig>{controller_names,
                           [](const Rig& rig) { return place_of(rig.controller, controller_names()); },
                           [](Rig& rig, std::size_t i) { rig.controller = controller_names()[i]; }},
     .meaning = "control law ([`equations.md`](equations.md))",
     .default_text = "`gain_scheduling_partial`; `none` for drive_axis and pendulum",
     .choices_text = "a name of [`registered.def`](../libs/control/src/laws/registered.def)"},
}};

inline constexpr std::array<Field<Planning>, 5> kPlanningFields{{
    {.key = "trajectory",
     .member = Choice<Planning>{[] {
                                  return std::vector<std::string>{"bang_coast_bang", "s_curve"};
                                },
                                [](const Planning& planning) -> std::size_t { return planning.limits_jerk; },
                                [](Planning& planning, std::size_t i) { planning.limits_jerk = i == 1; }},
     .meaning = "profile of planned moves; `s_curve` limits the jerk"},
    {.key = "shaper",
     .member = Choice<Planning>{
         [] {
           return std::vector<std::string>{"none", "zv", "zvd", "ei"};
         },
         [](const Planning& planning) { return static_cast<std::size_t>(planning.shaping); },
         [](Planning& planning, std::size_t i) { planning.shaping = static_cast<control::Shaping>(i); }},
     .meaning = "input shaper for the planned references of trolley and slew"},
    {.key = "planned_swing_rad",
     .member = &Planning::planned_swing_rad,
     .range = Range::closed(0.001, 1),
     .unit = "rad",
     .meaning = "`time_optimal`: largest swing of a plan",
     .default_text = "10°"},
    {.key = "planned_volt_share",
     .member = &Planning::planned_volt_share,
     .range = Range::closed(0.1, 1),
     .meaning = "`time_optimal`: share of `volt_limit_v` that a plan uses; the rest is left for tracking"},
    {.key = "planning_time_s",
     .member = &Planning::planning_time_s,
     .range = Range::closed(0, 10),
     .unit = "s",
     .meaning =
         "`time_optimal`: time from the request to the start of the plan; if no plan is ready by then, "
         "the input shaper `zv` shapes the move instead"},
}};

/// Calls visit(path, fields, section, unit) for every section of the rig. `path` is empty for the root;
/// `unit` is the unit of the section's coordinate. A section with two tables of fields is visited twice.
/// @tparam AnyRig  Rig or const Rig
template <class AnyRig, class Visit>
void for_each_section(AnyRig& rig, Visit&& visit) {
  visit(std::string{}, kRigFields, rig, "");
  visit(std::string{"plant"}, plant::kParameterFields, rig.plant, "");
  for (std::size_t i = 0; i < plant::kCoordinateCount; ++i) {
    const plant::Coordinate& coordinate = plant::kCoordinates[i];
    const std::string encoder = std::string{"encoder."} + coordinate.name;
    if (rig.measures(i)) visit(encoder, kEncoderFields, rig.encoders[i], coordinate.unit);
    if (i >= plant::kAxes && rig.measures(i)) visit(encoder, kRestFields, rig.encoders[i], "");
    if (i >= plant::kAxes || !rig.drives[i].present) continue;
    auto& drive = rig.drives[i];
    const auto of_drive = [&coordinate](const char* section) {
      return std::string{section} + coordinate.name;
    };
    visit(encoder, kZeroFields, drive, coordinate.unit);
    visit(of_drive("drive."), kDriveFields, drive, coordinate.unit);
    visit(of_drive("drive."), control::kDriveLimitFields, drive, coordinate.unit);
    if (drive.homes()) visit(of_drive("homing."), kMarkFields, drive.homing, coordinate.unit);
    if (drive.homes()) visit(of_drive("homing."), control::kHomingFields, drive.homing, coordinate.unit);
    visit(of_drive("wiring."), kDriveLineFields, rig.wiring.drives[i], coordinate.unit);
    visit(of_drive("controller.friction."), control::kFrictionFields, rig.design.friction[i],
          coordinate.unit);
  }
  visit(std::string{"wiring"}, kWiringFields, rig.wiring, "");
  visit(std::string{"sensing"}, kSensingFields, rig.sensing, "");
  visit(std::string{"limits"}, control::kOperatingLimitFields, rig.limits, "");
  visit(std::string{"start"}, kStartFields, rig.start, "");
  visit(std::string{"clearance"}, control::kClearanceFields, rig.clearance, "");
  visit(std::string{"controller"}, kControllerFields, rig, "");
  visit(std::string{"controller"}, kPlanningFields, rig.planning, "");
  visit(std::string{"controller"}, control::kDesignFields, rig.design, "");
  visit(std::string{"adaptation"}, control::kAdaptationFields, rig.design.adaptation, "");
  visit(std::string{"controller.believes"}, plant::kParameterFields, rig.design.crane, "");
}

}  // namespace crane::configuration
