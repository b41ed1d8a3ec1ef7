#pragma once
#include <optional>
#include <string_view>

namespace crane::recording {

/// Seconds since 1970 (UTC) of a date with time of day (ISO 8601, extended format):
/// "2024-03-14T10:22:31.551". `T` may be a space, the fraction may have a comma or be absent; "Z" or an
/// offset such as "+01:00" may follow. Without an offset, the time counts as UTC. @return nothing for any
/// other text
[[nodiscard]] std::optional<double> seconds_of_date(std::string_view text);

}  // namespace crane::recording
