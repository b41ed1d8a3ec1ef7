#pragma once
/// Options of the tests that call tune().
#include <spdlog/spdlog.h>

#include <filesystem>

#include "crane/workers/process_pool.hpp"
#include "stack/data_files.hpp"
#include "tuning/tune.hpp"

namespace crane::tuning {

/// All maneuvers, on all processors. Turns the log of this program off.
inline TuneOptions options_for(const std::filesystem::path& directory) {
  spdlog::set_level(spdlog::level::off);
  TuneOptions options{.directory = directory, .processors = workers::processors()};
  for (const char* name : stack::kManeuvers) options.maneuvers.push_back(stack::find_scenario(name));
  return options;
}

}  // namespace crane::tuning
