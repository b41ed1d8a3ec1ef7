#pragma once
/// Shared by the commands of `crane log`.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands/commands.hpp"
#include "crane/recording/mcap_edit.hpp"
#include "crane/recording/mcap_reader.hpp"

namespace crane::cli {

struct LogOptions {
  std::filesystem::path file, out;
  std::vector<std::filesystem::path> files;  ///< of merge: the recordings, then the new file
  recording::TimeRange range;
  std::string topic;
  bool json = false, force = false;
};
using LogAction = int (*)(const LogOptions&);
using SharedLogOptions = std::shared_ptr<LogOptions>;

/// Reports a recording of another message version, whose topics are decoded with the types in the recording.
void note_other_version(const recording::McapReader& recording);
void print_log_problems(const std::vector<std::string>& problems);

/// Runs the action. @return exit code; that of a wrong argument when a file is no recording, or cannot be
/// merged with the others
int run_log_action(LogAction action, const LogOptions& options);

/// Adds a command with one recording as argument.
CLI::App* add_log_command(CLI::App& parent, Action& chosen, const SharedLogOptions& options, LogAction action,
                          const char* name, const char* summary);
/// Adds --force.
void add_log_force(CLI::App* command, const SharedLogOptions& options);

/// `crane log export`
void add_log_export(CLI::App& log, Action& chosen, const SharedLogOptions& options);

}  // namespace crane::cli
