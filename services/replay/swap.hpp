#pragma once
/// Computes the demand of another controller: planner, tracking, anti-swing and friction compensation run
/// with the other controller and receive the recorded states and supervisor statuses. The recorded states
/// follow from the recorded commands. The difference therefore shows the demand of the other controller at
/// the same states; it does not simulate a crane with the other controller.
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "crane/plant/parameters.hpp"
#include "crane/recording/csv.hpp"
#include "replay/recorded_run.hpp"

namespace crane::replay {

/// Largest |demand of the other controller - recorded demand| of one axis, V.
struct LargestDifference {
  double difference_v = 0, recorded_v = 0, other_v = 0;
  std::uint64_t tick = 0;
  double time_s = 0;
};

struct SwapResult {
  std::string recorded, other;                          ///< controllers
  std::uint64_t ticks = 0;                              ///< compared
  std::optional<std::uint64_t> first_differs;           ///< first tick with another demand
  std::array<LargestDifference, plant::kAxes> largest;  ///< by axis (plant::Axis)
  recording::Table table;  ///< time_s, tick, and recorded and other demand of each axis in V
  std::vector<std::string> problems;
};

/// @param other  name of a controller. @throws recording::ReadError, Refusal,
///   configuration::ConfigurationError for an unknown controller
[[nodiscard]] SwapResult swap_controller(const std::filesystem::path& file, const std::string& other);

}  // namespace crane::replay
