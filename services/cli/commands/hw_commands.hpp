#pragma once
/// The commands below `crane hw`.
#include "cli/commands/commands.hpp"

namespace crane::cli {

void add_hw_list(CLI::App& hw, Action& chosen);
void add_hw_probe(CLI::App& hw, Action& chosen);
void add_hw_jog(CLI::App& hw, Action& chosen);
void add_hw_calibrate(CLI::App& hw, Action& chosen);
void add_hw_selftest(CLI::App& hw, Action& chosen);

}  // namespace crane::cli
