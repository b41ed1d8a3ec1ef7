/// crane black-box: writes a recording around every stop, fault and trip. `crane up` starts it.
#include "black_box/black_box.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "commands.hpp"

namespace crane::cli {

void add_black_box(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<black_box::Options>(black_box::default_options());
  auto* command = app.add_subcommand(
      "black-box",
      "Record every stop and fault, from 10 s before to 5 s after it (crane up starts this command)");
  black_box::add_options(*command, *options);
  command->footer(
      "Example: crane black-box --rig virginia_tech_tower --out black_box\n"
      "`crane review FILE` explains a recording.");
  command->callback([options, &chosen] { chosen = [options] { return black_box::run(*options); }; });
}

}  // namespace crane::cli
