#pragma once
/// The option --plant.
#include <CLI/CLI.hpp>
#include <string>

#include "stack/stack.hpp"

namespace crane::cli {

/// Adds --plant with the value of `plant` as default. @param plant  outlives the command
/// @param remark  appended to the description
inline void add_plant_option(CLI::App& command, stack::Plant& plant, const std::string& remark = "") {
  const auto set = [&plant](const std::string& name) {
    plant = name == "hardware" ? stack::Plant::hardware : stack::Plant::simulated;
  };
  command
      .add_option_function<std::string>("--plant", set,
                                        "sim: simulated plant; hardware: the board of the rig file" + remark)
      ->check(CLI::IsMember({"sim", "hardware"}))
      ->default_str(plant == stack::Plant::hardware ? "hardware" : "sim");
}

}  // namespace crane::cli
