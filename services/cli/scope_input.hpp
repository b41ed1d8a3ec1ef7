#pragma once
/// Feeds the rows of `crane scope`: from the bus, or from a recording.
#include <functional>

#include "cli/tool_bus.hpp"
#include "crane/recording/mcap_reader.hpp"
#include "observation/tick_rows.hpp"

namespace crane::cli {

/// Receives the topics of `rows` until `finished`, the timeout or a stop signal. After 3 s without a sample
/// it prints possible reasons once on standard error.
/// @param finished  called after each sample and at least every 20 ms
/// @throws std::runtime_error with the reason when no sample arrived at all
void feed_live(bus::Bus& bus, const observation::FieldTable& table, observation::TickRows& rows,
               double timeout_s, const std::function<bool()>& finished);

/// Reads the topics of `rows` to the end of the recording, or until `finished`. Problems of the file go to
/// standard error. @throws recording::DecodeError
void feed_recording(recording::McapReader& recording, const observation::FieldTable& table,
                    observation::TickRows& rows, const std::function<bool()>& finished);

}  // namespace crane::cli
