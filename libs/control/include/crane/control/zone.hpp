#pragma once
/// No-go zones: obstacles that the load, the hook and the cable must not enter. A zone is an upright box or
/// cylinder in coordinates of the ground: x along the jib at slew angle 0 (gantry: along the track), y in the
/// direction of positive slew, z upwards from the ground. docs/zones.md.
#include <array>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>

#include "crane/fields/field.hpp"
#include "crane/plant/parameter_fields.hpp"

namespace crane::control {

/// Largest number of zones of a rig. The supervisor checks every zone in every tick: 5 us for a hundred
/// (docs/zones.md).
inline constexpr std::size_t kMostZones = 100;

enum class ZoneShape { box, cylinder };

struct Zone {
  std::string name;
  ZoneShape shape = ZoneShape::box;
  double position_x_m = 0, position_y_m = 0;  ///< centre
  double size_x_m = 0, size_y_m = 0;          ///< box: lengths of the edges, parallel to x and y
  double radius_m = 0;                        ///< cylinder
  double bottom_m = 0, top_m = 0;             ///< heights above the ground

  bool operator==(const Zone&) const = default;
};

/// Section [clearance] of a rig file: size of the load, and errors that the zone filter allows for.
struct Clearance {
  double load_radius_m = 0;        ///< sphere around the end of the cable that contains hook and load
  double suspension_height_m = 0;  ///< height of the suspension point above the ground
  double cable_error = 0.1;        ///< largest |true - measured| cable length / measured length
  double wind_mps2 = 0.25;         ///< largest horizontal acceleration of the load by wind

  bool operator==(const Clearance&) const = default;
};

/// Permitted edge lengths and radii of zones, m: at most the largest position of an axis.
inline constexpr fields::Range kZoneSizes = fields::Range::closed(0, plant::kPositions.high);

inline constexpr std::array kZoneFields{
    fields::Field<Zone>{.key = "name",
                        .member = &Zone::name,
                        .meaning = "name of the zone in messages and in `crane zone`; not empty, unique",
                        .presence = fields::Presence::required},
    fields::Field<Zone>{.key = "shape",
                        .member = fields::Choice<Zone>{
                            [] {
                              return std::vector<std::string>{"box", "cylinder"};
                            },
                            [](const Zone& zone) { return static_cast<std::size_t>(zone.shape); },
                            [](Zone& zone, std::size_t i) { zone.shape = static_cast<ZoneShape>(i); }},
                        .meaning = "the axis of a cylinder is vertical",
                        .presence = fields::Presence::required},
    fields::Field<Zone>{.key = "position_x_m",
                        .member = &Zone::position_x_m,
                        .range = plant::kPositions,
                        .unit = "m",
                        .meaning = "x of the centre: along the jib at slew angle 0; gantry: along the track",
                        .presence = fields::Presence::required},
    fields::Field<Zone>{
        .key = "position_y_m",
        .member = &Zone::position_y_m,
        .range = plant::kPositions,
        .unit = "m",
        .meaning =
            "y of the centre: across the jib at slew angle 0, positive in the direction of positive slew; "
            "gantry: 0"},
    fields::Field<Zone>{.key = "size_x_m",
                        .member = &Zone::size_x_m,
                        .range = kZoneSizes,
                        .unit = "m",
                        .meaning = "length of the edge along x",
                        .default_text = "required for a box"},
    fields::Field<Zone>{.key = "size_y_m",
                        .member = &Zone::size_y_m,
                        .range = kZoneSizes,
                        .unit = "m",
                        .meaning = "length of the edge along y",
                        .default_text = "required for a box"},
    fields::Field<Zone>{.key = "radius_m",
                        .member = &Zone::radius_m,
                        .range = kZoneSizes,
                        .unit = "m",
                        .meaning = "radius",
                        .default_text = "required for a cylinder"},
    fields::Field<Zone>{
        .key = "bottom_m",
        .member = &Zone::bottom_m,
        .range = plant::kPositions,
        .unit = "m",
        .meaning = "height of the lower end. The cable must not enter the zone either: a load below a zone "
                   "violates it unless `bottom_m` is above the suspension point"},
    fields::Field<Zone>{.key = "top_m",
                        .member = &Zone::top_m,
                        .range = plant::kPositions,
                        .unit = "m",
                        .meaning = "height of the upper end, above `bottom_m`",
                        .presence = fields::Presence::required},
};

inline constexpr std::array kClearanceFields{
    fields::Field<Clearance>{.key = "load_radius_m",
                             .member = &Clearance::load_radius_m,
                             .range = fields::Range::closed(0, 100),
                             .unit = "m",
                             .meaning = "sphere around the end of the cable that contains hook and load",
                             .default_text = "required with zones"},
    fields::Field<Clearance>{
        .key = "suspension_height_m",
        .member = &Clearance::suspension_height_m,
        .range = plant::kPositions,
        .unit = "m",
        .meaning = "height of the suspension point of the cable above the ground; 0: "
                   "heights of zones are relative to the suspension point, and negative below it"},
    fields::Field<Clearance>{.key = "cable_error",
                             .member = &Clearance::cable_error,
                             .range = fields::Range::closed(0, 0.5),
                             .unit = "share",
                             .meaning = "largest |true - measured| cable length / measured length"},
    fields::Field<Clearance>{.key = "wind_mps2",
                             .member = &Clearance::wind_mps2,
                             .range = fields::Range::closed(0, 5),
                             .unit = "m/s²",
                             .meaning = "largest horizontal acceleration of the load by wind: force / mass "
                                        "of the load. The check of the swing encoders tolerates it"},
};

/// Space that load, hook and cable can reach: an upright cylinder from `lowest_m` to the suspension point.
struct ReachedSpace {
  double x_m = 0, y_m = 0;  ///< centre
  double radius_m = 0;
  double lowest_m = 0;  ///< height above the ground
};

/// Distance between a zone and a reached space, m; <= 0: they touch or overlap. It is the larger of
/// - the horizontal distance from the outline of the zone to the centre line of the space, minus the radius
///   of the space;
/// - the vertical distance between the nearer ends.
[[nodiscard]] double clearance_m(const Zone& zone, const ReachedSpace& space,
                                 double suspension_height_m) noexcept;

/// Space of a load that hangs at rest below this suspension point. Its radius contains the deflection by a
/// gust, 2 f L / g, with f = wind_mps2 and L = (1 + cable_error) cable_m. @param gravity_mps2  > 0
[[nodiscard]] ReachedSpace resting_space(const Clearance& clearance, double gravity_mps2, double trolley_m,
                                         double slew_rad, double cable_m) noexcept;

/// @return the first zone whose clearance from the straight path of a move is below `least_clearance_m`;
/// nullptr: none. The path is straight in the coordinates of the axes. A path that begins below this
/// clearance is permitted while its clearance does not decrease.
/// @param from, to  trolley m, slew rad, cable m
[[nodiscard]] const Zone* zone_in_path(std::span<const Zone> zones, const Clearance& clearance,
                                       double gravity_mps2, const plant::PerAxis& from,
                                       const plant::PerAxis& to, double least_clearance_m) noexcept;

}  // namespace crane::control
