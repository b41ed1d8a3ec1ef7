#pragma once
/// `crane doctor`: why a crane is not heard, and what of this computer hinders it.
#include <string>

#include "crane/runtime/process.hpp"
#include "doctor/finding.hpp"
#include "stack/data_files.hpp"

namespace crane::doctor {

struct Options {
  bool network = true, real_time = true, hardware = true;
  std::string rig = stack::kDefaultRig;  ///< period of the loop, board
  double duration_s = 3;                 ///< of listening, and of measuring the timer
  int priority = 50;                     ///< SCHED_FIFO priority of the loop
  runtime::BusOptions bus;
};
/// @throws ConfigurationError, bus::Error
[[nodiscard]] Findings examine(const Options& options);

}  // namespace crane::doctor
