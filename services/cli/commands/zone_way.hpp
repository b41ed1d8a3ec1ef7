#pragma once
/// The subcommand `way` of `crane zone`.
#include "commands.hpp"

namespace crane::cli {

void add_zone_way(CLI::App& group, Action& chosen);

}  // namespace crane::cli
