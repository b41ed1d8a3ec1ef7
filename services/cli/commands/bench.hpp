#pragma once
/// Measurements of `crane bench`, one file each.
#include "cli/commands/commands.hpp"

namespace crane::cli {

void add_bench_cpu(CLI::App& bench, Action& chosen);
void add_bench_fleet(CLI::App& bench, Action& chosen);
void add_bench_stop(CLI::App& bench, Action& chosen);
void add_bench_tick(CLI::App& bench, Action& chosen);
void add_bench_diagnosis(CLI::App& bench, Action& chosen);

}  // namespace crane::cli
