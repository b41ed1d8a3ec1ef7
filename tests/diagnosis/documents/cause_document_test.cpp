/// docs/terms.md shows the terms of the model (plant/model), the candidates of the diagnosis and the causes
/// of the twin. docs/diagnosis.md shows the confounded groups of the score,
/// docs/diagnosis_thresholds.md the rules of the report.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "crane/diagnosis/candidate.hpp"
#include "crane/plant/term.hpp"
#include "crane/twin/hypothesis.hpp"
#include "documents/term_document.hpp"
#include "laboratory/data_of_truth.hpp"
#include "rules.hpp"
#include "score/judgement.hpp"

namespace crane::diagnosis {
namespace {

using Names = std::set<std::string>;

/// Causes of the candidates on a tower crane with all sensors; a weight hangs on its trolley.
Names candidate_causes() {
  truth::Case request;
  request.rig = "tower";
  request.seed = 1;
  request.training_runs = {"rich"};
  request.seconds = 20;
  DataOfTruth data(request);
  data.rig.terms.push_back({"position_force", "trolley", {{"offset_v", 0.1}}});
  Names names;
  for (const Candidate& candidate : candidates_for(data.rig, data.train)) names.insert(candidate.cause);
  return names;
}

Names causes_of_the_twin() {
  Names names;
  for (const twin::CauseKind& kind : twin::cause_kinds()) names.insert(kind.name);
  return names;
}

std::string group_table() {
  std::string table = "| causes | separated by |\n|---|---|\n";
  for (const score::ConfoundedGroup& group : score::confounded_groups()) {
    std::string causes;
    for (const std::string& cause : group.causes) causes += (causes.empty() ? "`" : ", `") + cause + '`';
    table += "| " + causes + " | " + group.separated_by + " |\n";
  }
  return table;
}

std::string document(const std::string& name) {
  std::ifstream in{CRANE_RIGS "/../../docs/" + name};
  return {std::istreambuf_iterator<char>{in}, {}};
}

/// Replaces the text between "<!-- MARK -->" and "<!-- end -->".
std::string with(std::string text, const std::string& mark, const std::string& generated) {
  const std::string begin = "<!-- " + mark + " -->\n";
  const auto at = text.find(begin);
  if (at == std::string::npos) return text + begin + generated + "<!-- end -->\n";
  return text.replace(at + begin.size(), text.find("<!-- end -->", at) - at - begin.size(), generated);
}

void expect_document(const std::string& name, const std::string& mark, const std::string& generated) {
  const std::string shown = document(name), right = with(shown, mark, generated);
  const auto copy = std::filesystem::path{testing::TempDir()} / name;
  std::ofstream{copy} << right;
  EXPECT_EQ(shown, right) << "put " << copy << " there";
}

std::vector<std::string> parts_of(const std::string& text, const std::string& separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos;
       begin = end + separator.size())
    parts.push_back(text.substr(begin, end - begin));
  parts.push_back(text.substr(begin));
  return parts;
}

/// "clear_win" of "`kClearWin`"
std::string rule_name(const std::string& constant) {
  std::string name;
  for (const char c : constant) {
    if (c == '`' || (c == 'k' && name.empty())) continue;
    const bool upper = c >= 'A' && c <= 'Z';
    if (upper && !name.empty()) name += '_';
    name += static_cast<char>(upper ? c - 'A' + 'a' : c);
  }
  return name;
}

/// The values of the table of thresholds, by the name of the rule. A row lists names, values and units; one
/// unit may belong to all values. A unit that begins with % is a share.
std::map<std::string, double> documented_thresholds() {
  std::map<std::string, double> values;
  for (const std::string& line : parts_of(document("diagnosis_thresholds.md"), "\n")) {
    if (!line.starts_with("| `k")) continue;
    const auto cells = parts_of(line.substr(2), " | ");
    const auto names = parts_of(cells.at(0), ", "), numbers = parts_of(cells.at(1), ", "),
               units = parts_of(cells.at(2), ", ");
    if (names.size() != numbers.size()) continue;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const bool percent = units[std::min(i, units.size() - 1)].starts_with('%');
      values[rule_name(names[i])] = std::stod(numbers[i]) / (percent ? 100 : 1);
    }
  }
  return values;
}

TEST(DiagnosisDocument, ShowsTheValueOfEachRuleOfTheReport) {
  const auto shown = documented_thresholds();
  for (const Rule& rule : rules::kAll) {
    const auto found = shown.find(rule.name);
    ASSERT_NE(found, shown.end()) << rule.name << ": add a row to docs/diagnosis_thresholds.md";
    EXPECT_DOUBLE_EQ(found->second, rule.value) << rule.name;
  }
}

TEST(TermDocument, ShowsTheTermsAndWhatFindsThem) {
  expect_document("terms.md", "terms", test::term_list(candidate_causes(), causes_of_the_twin()));
}

TEST(DiagnosisDocument, ShowsTheConfoundedGroupsOfTheScore) {
  expect_document("diagnosis.md", "confounded causes", group_table());
}

TEST(Causes, OfTheConfoundedGroupsAreTerms) {
  for (const score::ConfoundedGroup& group : score::confounded_groups())
    for (const std::string& cause : group.causes) EXPECT_NE(plant::find_term(cause), nullptr) << cause;
}

TEST(Causes, WhoseParametersTheScoreComparesAreTermsWithTheseParameters) {
  for (const score::SharedParameter& shared : score::shared_parameters()) {
    const plant::TermKind* term = plant::find_term(shared.cause);
    ASSERT_NE(term, nullptr) << shared.cause;
    EXPECT_NE(plant::find_parameter(*term, shared.library), nullptr) << shared.cause << ' ' << shared.library;
  }
}

}  // namespace
}  // namespace crane::diagnosis
