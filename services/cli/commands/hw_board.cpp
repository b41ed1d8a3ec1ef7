#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>

#include "cli/commands/hw.hpp"
#include "crane/boards/emulated_board.hpp"
#include "crane/boards/linked_rig.hpp"
#include "crane/emulated_rig/component.hpp"
#include "crane/emulated_rig/wired_rig.hpp"
#include "crane/runtime/in_process.hpp"
#include "stack/data_files.hpp"

namespace crane::cli {
namespace {

/// Sleeps until the next tick; skips the ticks that passed while the program waited for an answer.
std::function<void(std::int64_t)> sleeping() {
  return [next_ns = std::int64_t{0}](std::int64_t duration_ns) mutable {
    next_ns = std::max(next_ns, runtime::monotonic_ns() - duration_ns) + duration_ns;
    const timespec at{.tv_sec = next_ns / 1'000'000'000, .tv_nsec = next_ns % 1'000'000'000};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
  };
}

}  // namespace

void add_board_options(CLI::App& command, BoardOptions& options) {
  command.add_option("--rig", options.rig, "rig file or name: board, channels and lines")->required();
  auto* wired = command.add_option(
      "--wired-as", options.wired_as,
      "emulated board only: rig file with the wiring of the emulated crane, to rehearse faults");
  auto* crane =
      command.add_option("--crane", options.crane,
                         "emulated board only: use the running crane_emulated_rig with this --crane; "
                         "default: an emulated crane in this process");
  command.add_option("--domain", options.domain, "--domain of this crane_emulated_rig")->needs(crane);
  crane->excludes(wired);
}

OpenBoard::OpenBoard(const BoardOptions& options)
    : rig_{configuration::load_rig(stack::find_rig(options.rig))},
      bus_{runtime::memory_options(bus::make_memory_network(), "crane_hw", crane_SOURCE_OPERATOR)},
      node_{bus_, {"crane_hw", ""}} {
  clock_.interrupted = runtime::stop_requested;
  const bool emulated = bridge::board_kind_of(rig_).name == "emulated";
  if (!emulated && !(options.wired_as.empty() && options.crane.empty()))
    throw configuration::ConfigurationError({rig_.path + ": board = " + rig_.board +
                                             ": --wired-as and --crane apply to the emulated board only"});
  if (!emulated || !options.crane.empty()) {
    clock_.wait = sleeping();
    clock_.now_ns = runtime::monotonic_ns;
  }
  board_ = opened(options);
}

std::unique_ptr<bridge::Board> OpenBoard::opened(const BoardOptions& options) {
  if (!options.crane.empty())
    return std::make_unique<bridge::EmulatedBoard>(
        rig_, std::make_unique<bridge::LinkedRig>(bridge::shared_lines_name(options.crane, options.domain)));
  if (!options.wired_as.empty())
    return std::make_unique<bridge::EmulatedBoard>(
        rig_,
        std::make_unique<emulated_rig::WiredRig>(configuration::load_rig(stack::find_rig(options.wired_as))));
  if (bridge::board_kind_of(rig_).name == "emulated") return emulated_rig::open_board(rig_);
  return bridge::board_kind_of(rig_).make(rig_, bus_.options());
}

}  // namespace crane::cli
