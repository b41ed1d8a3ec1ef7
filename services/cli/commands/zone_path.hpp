#pragma once
/// The subcommand `path` of `crane zone`.
#include "commands.hpp"

namespace crane::cli {

void add_zone_path(CLI::App& group, Action& chosen);

}  // namespace crane::cli
