#pragma once
/// The commands of `crane`, one file and one line each. Each function registers a command and its options.
/// Parsing stores the action of the given command in `chosen`. The action returns the exit code; main()
/// reports its exceptions.
#include <functional>

#include "crane/runtime/process.hpp"

namespace crane::cli {

using Action = std::function<int()>;

void add_up(CLI::App& app, Action& chosen);
void add_demo(CLI::App& app, Action& chosen);
void add_run(CLI::App& app, Action& chosen);
void add_sweep(CLI::App& app, Action& chosen);
void add_status(CLI::App& app, Action& chosen);
void add_top(CLI::App& app, Action& chosen);
void add_scope(CLI::App& app, Action& chosen);
void add_reset(CLI::App& app, Action& chosen);
void add_arm(CLI::App& app, Action& chosen);
void add_home(CLI::App& app, Action& chosen);
void add_disarm(CLI::App& app, Action& chosen);
void add_mode(CLI::App& app, Action& chosen);
void add_move(CLI::App& app, Action& chosen);
void add_jog(CLI::App& app, Action& chosen);
void add_stop(CLI::App& app, Action& chosen);
void add_estop(CLI::App& app, Action& chosen);
void add_topic(CLI::App& app, Action& chosen);
void add_graph(CLI::App& app, Action& chosen);
void add_doctor(CLI::App& app, Action& chosen);
void add_dashboard(CLI::App& app, Action& chosen);
void add_black_box(CLI::App& app, Action& chosen);
void add_review(CLI::App& app, Action& chosen);
void add_record(CLI::App& app, Action& chosen);
void add_play(CLI::App& app, Action& chosen);
void add_replay(CLI::App& app, Action& chosen);
void add_log(CLI::App& app, Action& chosen);
void add_identify(CLI::App& app, Action& chosen);
void add_tune(CLI::App& app, Action& chosen);
void add_diagnose(CLI::App& app, Action& chosen);
void add_analyse(CLI::App& app, Action& chosen);
void add_hw(CLI::App& app, Action& chosen);
void add_bench(CLI::App& app, Action& chosen);
void add_keys(CLI::App& app, Action& chosen);
void add_campaign(CLI::App& app, Action& chosen);
void add_supervisor(CLI::App& app, Action& chosen);
void add_zone(CLI::App& app, Action& chosen);
void add_completion(CLI::App& app, Action& chosen);
void add_man(CLI::App& app, Action& chosen);

}  // namespace crane::cli
