#pragma once
/// Force of one frequency on drives or load: a line of the spectrum.
#include <cstdint>
#include <optional>

#include "force/unexplained.hpp"

namespace crane::diagnosis {

/// The strongest line. Nothing if its cross-validated gain is below a share of the loss, or if one of 99
/// random sign flips of the pieces has as large a gain.
/// @param seed of the sign flips
/// @param volt_acceleration  acceleration of a drive per volt of its command, m/s^2/V or rad/s^2/V. A run is
///   omitted from a line that its command contains if the force is small beside the command
///   (docs/diagnosis_method.md, 9). 0: no run is omitted
[[nodiscard]] std::optional<Unexplained> find_force_line(const Pieces& pieces, std::uint64_t seed,
                                                         double volt_acceleration = 0);

}  // namespace crane::diagnosis
