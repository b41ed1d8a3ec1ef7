/// docs/diagnosis.md shows the causes of the code: terms of the model (plant/model), candidates of the
/// diagnosis, causes of the twin, and the confounded groups of the score.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "crane/diagnosis/candidate.hpp"
#include "crane/plant/term.hpp"
#include "crane/twin/hypothesis.hpp"
#include "data_of_truth.hpp"
#include "judgement.hpp"

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

std::string yes_or_no(bool value) { return value ? "yes" : "no"; }

std::string cause_table() {
  const Names candidates = candidate_causes();
  std::string table =
      "| cause | what it describes | candidate of `crane diagnose` | cause of the twin "
      "|\n|---|---|---|---|\n";
  for (const plant::TermKind& term : plant::term_kinds()) {
    const std::string name{term.name};
    const bool of_twin = std::ranges::any_of(
        twin::cause_kinds(), [&](const twin::CauseKind& kind) { return kind.name == term.name; });
    table += "| `" + name + "` | " + std::string{term.source} + " | " + yes_or_no(candidates.contains(name)) +
             " | " + yes_or_no(of_twin) + " |\n";
  }
  return table;
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

/// The text between "<!-- NAME -->" and "<!-- end -->" of docs/diagnosis.md.
std::string shown(const std::string& name) {
  std::ifstream in{CRANE_RIGS "/../../docs/diagnosis.md"};
  const std::string text{std::istreambuf_iterator<char>{in}, {}}, begin = "<!-- " + name + " -->\n";
  const auto at = text.find(begin);
  if (at == std::string::npos) return "no " + begin;
  return text.substr(at + begin.size(), text.find("<!-- end -->", at) - at - begin.size());
}

TEST(DiagnosisDocument, ShowsTheCauses) { EXPECT_EQ(shown("causes"), cause_table()); }

TEST(DiagnosisDocument, ShowsTheConfoundedGroupsOfTheScore) {
  EXPECT_EQ(shown("confounded causes"), group_table());
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
