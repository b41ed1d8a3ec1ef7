#pragma once
/// `crane doctor`: checks network, real-time settings and board, and names the remedy for each problem.
#include <string>

#include "crane/runtime/process.hpp"
#include "doctor/finding.hpp"
#include "stack/data_files.hpp"

namespace crane::doctor {

struct Options {
  bool network = true, real_time = true, hardware = true;
  std::string rig = stack::kDefaultRig;  ///< determines the period of the loop and the board
  double duration_s = 3;                 ///< duration of listening and of the timer measurement
  int priority = 50;                     ///< SCHED_FIFO priority of the loop
  runtime::BusOptions bus;
};
/// @throws ConfigurationError, bus::Error
[[nodiscard]] Findings examine(const Options& options);

}  // namespace crane::doctor
