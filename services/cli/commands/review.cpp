/// crane review: reviews a recording.
#include "review/review.hpp"
#include "cli/recording_argument.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/recording/parts.hpp"

namespace crane::cli {
namespace {

struct ReviewOptions {
  std::filesystem::path file, out;
  bool json = false;
};

/// Number of rows of the curves of --json: more than the columns of a screen.
constexpr std::size_t kMostPoints = 2000;

int run(const ReviewOptions& options) {
  try {
    auto out = options.out;
    if (out.empty()) out = std::filesystem::path{options.file}.replace_extension("html");
    configuration::require_other({out}, recording::files_of(options.file));
    const auto found = review::review(options.file);
    if (options.json)
      std::cout << review::to_json(found, kMostPoints).dump(2) << '\n';
    else
      for (const auto& line : review::sentences(found)) std::cout << line << '\n';
    report::write_html(out, review::page_of(found));
    if (!options.json) std::cout << "page: " << out.string() << '\n';
    return runtime::kExitDone;
  } catch (const recording::ReadError& error) {
    std::cerr << "crane: " << error.what() << '\n';
    return runtime::kExitBadInput;
  }
}

}  // namespace

void add_review(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<ReviewOptions>();
  auto* command =
      app.add_subcommand("review", "Explain the stop in a recording, first cause first, and write a page");
  command->add_option("FILE", options->file, "recording (.mcap)")->required()->check(existing_recording());
  command->add_option("--out", options->out, "page to write; default: FILE with the extension .html");
  command->add_flag("--json", options->json, "print sentences, figures and curves as one JSON object");
  command->footer("Example: crane review ~/.local/state/crane/black_box/20261125T035501Z_SWING_LIMIT.mcap");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace crane::cli
