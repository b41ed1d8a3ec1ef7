#pragma once
/// The commands below `crane topic`.
#include "commands.hpp"

namespace crane::cli {

void add_topic_ls(CLI::App& topic, Action& chosen);
void add_topic_echo(CLI::App& topic, Action& chosen);
void add_topic_hz(CLI::App& topic, Action& chosen);
void add_topic_delay(CLI::App& topic, Action& chosen);

}  // namespace crane::cli
