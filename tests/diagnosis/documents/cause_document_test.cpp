/// docs/terms.md shows the terms of the model (plant/model), the candidates of the diagnosis and the causes
/// of the twin. docs/diagnosis.md shows the confounded groups of the score.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "crane/diagnosis/candidate.hpp"
#include "crane/plant/term.hpp"
#include "crane/twin/hypothesis.hpp"
#include "documents/term_document.hpp"
#include "laboratory/data_of_truth.hpp"
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
