#pragma once
/// What another controller would have demanded: planner, tracking, anti-swing and friction compensation with
/// another controller receive the recorded states and supervisor statuses. The recorded states follow from
/// the recorded commands: the difference shows what the other controller demands at the same states, and is
/// no simulation of a crane with the other controller.
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "crane/recording/csv.hpp"
#include "replay/recorded_run.hpp"

namespace crane::replay {

/// Largest |demand of the other controller - recorded demand| of one axis.
struct LargestDifference {
  double difference_v = 0, recorded_v = 0, other_v = 0;
  std::uint64_t tick = 0;
  double time_s = 0;
};

struct SwapResult {
  std::string recorded, other;                 ///< controllers
  std::uint64_t ticks = 0;                     ///< compared
  std::optional<std::uint64_t> first_differs;  ///< first tick with another demand
  std::array<LargestDifference, 3> largest;    ///< trolley, slew, hoist
  recording::Table table;  ///< time_s, tick, and recorded and other demand of each axis in V
  std::vector<std::string> problems;
};

/// @param other  name of a controller. @throws recording::ReadError, Refusal,
///   configuration::ConfigurationError for an unknown controller
[[nodiscard]] SwapResult swap_controller(const std::filesystem::path& file, const std::string& other);

}  // namespace crane::replay
