/// crane analyse fuzzy: Table 3.7 and the rules that the method of the source generates.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/commands/analyse.hpp"
#include "cli/text_table.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/control/fuzzy.hpp"
#include "stack/data_files.hpp"

namespace crane::cli {
namespace {

std::string label_text(control::FuzzyLabel label) { return std::string{control::label_name(label)}; }

/// Prints a rule table; rows: swing, columns: swing rate. A star marks a difference from `reference`.
void print_rules(const control::FuzzyRules& marked, const control::FuzzyRules& reference) {
  std::vector<std::string> header{"phi \\ phi'"};
  for (control::FuzzyLabel label = -3; label <= 3; ++label) header.push_back(label_text(label));
  TextTable table{header};
  for (std::size_t i = 0; i < marked.size(); ++i) {
    std::vector<std::string> row{header[i + 1]};
    for (std::size_t j = 0; j < marked[i].size(); ++j)
      row.push_back(label_text(marked[i][j]) + (marked[i][j] == reference[i][j] ? "" : "*"));
    table.add(row);
  }
  table.print(std::cout);
}

nlohmann::ordered_json rules_json(const control::FuzzyRules& rules) {
  nlohmann::ordered_json json;
  for (const auto& row : rules) {
    nlohmann::ordered_json labels;
    for (const auto label : row) labels.push_back(label_text(label));
    json.push_back(labels);
  }
  return json;
}

int analyse_fuzzy(const std::string& rig, bool as_json) {
  const auto design = configuration::load_rig(stack::find_rig(rig)).design;
  const auto generated = control::rules_from(control::delayed_1_response(design));
  const auto agreement = control::agreement(generated);
  constexpr auto kRules = control::kFuzzyLabels * control::kFuzzyLabels;
  if (as_json) {
    const nlohmann::ordered_json json{{"printed", rules_json(control::kPrintedRules)},
                                      {"generated", rules_json(generated.rules)},
                                      {"rules", kRules},
                                      {"exact", agreement.exact},
                                      {"within_one_label", agreement.within_one}};
    std::cout << json.dump(2) << '\n';
    return runtime::kExitDone;
  }
  std::cout << "Table 3.7 as printed: label of the output for swing (rows) and swing rate (columns)\n";
  print_rules(control::kPrintedRules, control::kPrintedRules);
  std::cout << "\nGenerated after Wang and Mendel from the response of delayed_1; *: differs from the "
               "printed table\n";
  print_rules(generated.rules, control::kPrintedRules);
  std::cout << "\nOf " << kRules << " rules " << agreement.exact << " are equal, " << agreement.within_one
            << " differ by at most one label.\n";
  return runtime::kExitDone;
}

}  // namespace

void add_analyse_fuzzy(CLI::App& analyse, Action& chosen) {
  struct FuzzyOptions {
    std::string rig = stack::kDefaultRig;
    bool json = false;
  };
  auto options = std::make_shared<FuzzyOptions>();
  auto* command = analyse.add_subcommand("fuzzy", "Compare the printed with the generated fuzzy rules");
  command
      ->add_option("--rig", options->rig,
                   "rig file or name; the rules are generated for its controller parameters")
      ->capture_default_str();
  command->add_flag("--json", options->json, "print as JSON");
  command->footer("Example: crane analyse fuzzy");
  command->callback(
      [options, &chosen] { chosen = [options] { return analyse_fuzzy(options->rig, options->json); }; });
}

}  // namespace crane::cli
