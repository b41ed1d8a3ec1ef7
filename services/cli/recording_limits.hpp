#pragma once
/// Options that split a recording into parts and limit its size.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "recorder/recording_files.hpp"

namespace crane::cli {

struct LimitOptions {
  std::string split_size, split_every, quota;  ///< as given; empty: none
};
/// @param prefix  of the names of the options: "--" or "--record-"
void add_limit_options(CLI::App& command, LimitOptions& options, const std::string& prefix = "--");
/// The given options as arguments of `crane record`.
[[nodiscard]] std::vector<std::string> arguments(const LimitOptions& options);

/// @throws configuration::ConfigurationError with all problems
[[nodiscard]] recorder::Limits limits_of(const LimitOptions& options);

}  // namespace crane::cli
