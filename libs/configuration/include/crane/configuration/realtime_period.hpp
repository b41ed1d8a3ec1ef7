#pragma once
/// Shortest period of a control loop in real time.
#include "crane/configuration/rig.hpp"

namespace crane::configuration {

/// Shortest period in real time [s]: 1 kHz, the fastest loop that this project aims at. In a shorter period
/// the processes of the loop find no time to wait for samples: their states count as late or as those of a
/// second writer, and the limit of the processor time of a real-time thread ends the processes.
inline constexpr double kShortestRealtimePeriod_s = 0.001;

/// @throws ConfigurationError with file, key, value and rule when the rig cannot run in real time
void require_realtime_period(const Rig& rig);

}  // namespace crane::configuration
