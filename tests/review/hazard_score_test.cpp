/// Compares the first cause of a review with the judge of the fault campaign, which shares no code with it,
/// for recordings of every hazard at every moment.
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <iostream>
#include <map>

#include "../recording/temporary_directory.hpp"
#include "campaign/campaign.hpp"
#include "crane/bridge/last_line.hpp"
#include "crane/supervisor/states.hpp"
#include "review/review.hpp"

namespace crane::review {
namespace {

/// The note that names the reason; empty: no stop.
std::string name_of(const campaign::Result& result) {
  if (!result.stopped) return "";
  if (result.first.latch != crane_LATCH_NONE)
    return "LATCH_" + std::string{bridge::name_of(static_cast<bridge::Reason>(result.first.latch))};
  return supervisor::name_of(static_cast<supervisor::Cause>(result.first.cause));
}

std::string named_by(const Review& review) {
  const auto* cause = review.first_cause();
  return cause == nullptr ? "" : cause->what;
}

/// The judge ignores the time before the onset. A review that finds only an earlier request of the operator
/// is correct when the judge found no stop.
bool is_right(const Review& review, const campaign::Result& result) {
  const auto* cause = review.first_cause();
  return named_by(review) == name_of(result) ||
         (!result.stopped && cause != nullptr && cause->kind == observation::Note::Kind::order);
}

TEST(ReviewOfHazards, NamesTheFirstCauseOfAtLeast95Percent) {
  constexpr double kLeastShare = 0.95;  // of the recordings, and each hazard counts the same
  spdlog::set_level(spdlog::level::off);
  const recording::TemporaryDirectory directory;
  struct Score {
    int right = 0, all = 0;
    std::string wrong;
  };
  std::map<int, Score> scores;
  for (const auto& tuple : campaign::tuples({})) {
    const auto file = directory / "run.mcap";
    const auto result = campaign::run_one(tuple, file);
    if (!result.prepared || !std::filesystem::exists(file)) continue;  // refused before it ran
    const auto found = review(file);
    std::filesystem::remove(file);
    auto& score = scores[tuple.hazard];
    ++score.all;
    if (is_right(found, result))
      ++score.right;
    else
      score.wrong +=
          "\n  " + to_string(tuple) + ": \"" + named_by(found) + "\", judge: \"" + name_of(result) + "\"";
  }
  ASSERT_GE(scores.size(), 20U);
  double sum = 0;
  for (const auto& [hazard, score] : scores) {
    sum += static_cast<double>(score.right) / score.all;
    if (score.right < score.all)
      std::cout << "hazard " << hazard << ": " << score.right << " of " << score.all << score.wrong << '\n';
  }
  const double share = sum / static_cast<double>(scores.size());
  std::cout << "first cause right: " << 100 * share << " % of " << scores.size() << " hazards\n";
  EXPECT_GE(share, kLeastShare);
}

}  // namespace
}  // namespace crane::review
