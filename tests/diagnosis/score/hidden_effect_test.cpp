/// Hidden effects: code that shares nothing with the diagnosis writes CSV files and a sealed answer. Each
/// cause is tested once at a clearly visible amplitude, on the smallest rig and with the shortest data that
/// show it. `crane bench diagnosis` scores weak effects and long data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <set>

#include "score/hidden_set.hpp"

namespace crane::diagnosis::score {
namespace {

using testing::AnyOf;

TEST(TheSets, ContainEveryCauseAndEveryEffectOutsideTheLibrary) {
  std::set<std::string> hidden;
  for (const auto* sets : {&kFoundAlone, &kAlike, &kNotFoundYet, &kOutside})
    for (const HiddenSet& set : *sets) hidden.insert(set.name);
  for (const truth::EffectKind& kind : truth::effect_kinds())
    EXPECT_TRUE(hidden.contains(kind.name)) << kind.name;
}

class EveryCause : public testing::TestWithParam<HiddenSet> {};

TEST_P(EveryCause, IsNamedAloneAndReducesTheHeldOutError) {
  const SealedCase sealed(case_of(GetParam()));
  const Diagnosis found = sealed.diagnosed();
  EXPECT_EQ(judge(found, sealed.answer()), Judged::right) << found.sentence;
  EXPECT_GT(found.held_out.gain, 0);
}
INSTANTIATE_TEST_SUITE_P(Hidden, EveryCause, testing::ValuesIn(kFoundAlone), name_of_test);

/// Causes that are not found in these data: no other cause may be named with confidence.
class KnownShortcoming : public testing::TestWithParam<HiddenSet> {};

TEST_P(KnownShortcoming, IsNoOtherCauseWithConfidence) {
  const SealedCase sealed(case_of(GetParam()));
  const Diagnosis found = sealed.diagnosed();
  const Judged judged = judge(found, sealed.answer());
  std::printf("%s: %s\n", name_of(judged), found.sentence.c_str());
  EXPECT_NE(judged, Judged::wrong) << found.sentence;
}
INSTANTIATE_TEST_SUITE_P(Hidden, KnownShortcoming, testing::ValuesIn(kNotFoundYet), name_of_test);

class WithoutItsTerm : public testing::TestWithParam<HiddenSet> {};

/// The library without the hidden term: only a confounded cause may be named with confidence.
TEST_P(WithoutItsTerm, NoOtherCauseIsNamedWithConfidence) {
  const SealedCase sealed(case_of(GetParam()));
  Request request;
  request.excluded = {GetParam().name};
  const Diagnosis found = sealed.diagnosed(request);
  EXPECT_NE(judge(found, sealed.answer()), Judged::wrong) << found.sentence;
}
INSTANTIATE_TEST_SUITE_P(Hidden, WithoutItsTerm, testing::ValuesIn(kWithoutTerm), name_of_test);

class SwitchedOff : public testing::TestWithParam<HiddenSet> {};

/// With amplitude 0 the data do not depend on the effect (data_test.cpp of the truth): one set per rig and
/// seed.
TEST_P(SwitchedOff, NothingIsFound) {
  const SealedCase sealed(case_of(GetParam()));
  ASSERT_TRUE(sealed.answer().empty());
  const Diagnosis found = sealed.diagnosed();
  EXPECT_EQ(found.verdict, Verdict::none) << found.sentence;
  EXPECT_EQ(found.extension.size(), found.calibrated.size())
      << "only values within the accuracy of the rig file";
}
INSTANTIATE_TEST_SUITE_P(Hidden, SwitchedOff, testing::ValuesIn(kSwitchedOff), name_of_test);

class OutsideTheLibrary : public testing::TestWithParam<HiddenSet> {};

TEST_P(OutsideTheLibrary, IsUnknown) {
  const SealedCase sealed(case_of(GetParam()));
  const Diagnosis found = sealed.diagnosed();
  EXPECT_EQ(found.verdict, Verdict::unknown) << found.sentence;
}
INSTANTIATE_TEST_SUITE_P(Hidden, OutsideTheLibrary, testing::ValuesIn(kOutside), name_of_test);

class TwoAtOnce : public testing::TestWithParam<HiddenPair> {};

TEST_P(TwoAtOnce, AreBothNamed) {
  truth::Case request = case_of(GetParam().first);
  request.effects.push_back({GetParam().second.name, GetParam().second.amplitude, GetParam().second.axis});
  const SealedCase sealed(request);
  const Diagnosis found = sealed.diagnosed();
  EXPECT_EQ(judge(found, sealed.answer()), Judged::right) << found.sentence;
}
INSTANTIATE_TEST_SUITE_P(Hidden, TwoAtOnce, testing::ValuesIn(kPairs), [](const auto& tested) {
  return std::string{tested.param.first.name} + "_and_" + tested.param.second.name;
});

class Alike : public testing::TestWithParam<HiddenSet> {};

TEST_P(Alike, AreAmbiguousOrRightAndResolvedByTheProposedRun) {
  truth::Case request = case_of(GetParam());
  const SealedCase sealed(request);
  const Diagnosis found = sealed.diagnosed();
  const Judged first = judge(found, sealed.answer());
  ASSERT_THAT(first, AnyOf(Judged::right, Judged::among)) << found.sentence;
  if (first == Judged::right || !found.next_experiment) return;
  const std::string run = run_like(found.next_experiment->name);
  ASSERT_NE(run, "") << found.next_experiment->name;
  request.training_runs.push_back(run);
  const SealedCase more(request);
  const Diagnosis again = more.diagnosed();
  EXPECT_EQ(judge(again, more.answer()), Judged::right) << run << ": " << again.sentence;
}
INSTANTIATE_TEST_SUITE_P(Hidden, Alike, testing::ValuesIn(kAlike), name_of_test);

/// New, printed seeds. A correct build, whose share of right verdicts is kRightOnFreshSeeds, fails this test
/// once in 10,000 runs.
TEST(FreshSeeds, AreJudgedRightAsABatch) {
  const char* given = std::getenv("CRANE_DIAGNOSIS_SEED");
  const std::uint64_t seed = given != nullptr ? std::stoull(given) : std::random_device{}();
  std::printf("CRANE_DIAGNOSIS_SEED=%llu\n", static_cast<unsigned long long>(seed));
  int right = 0;
  std::string others;
  for (std::size_t i = 0; i < kBatch; ++i) {
    HiddenSet set = kFreshCauses[(seed + i) % kFreshCauses.size()];
    set.seed = seed + i;
    const SealedCase sealed(case_of(set));
    const Diagnosis found = sealed.diagnosed();
    if (judge(found, sealed.answer()) == Judged::right)
      ++right;
    else
      others += std::string{"\n  "} + set.name + ", seed " + std::to_string(set.seed) + ": " + found.sentence;
  }
  const boost::math::binomial_distribution<> of_a_correct_build(kBatch, kRightOnFreshSeeds);
  EXPECT_GE(boost::math::cdf(of_a_correct_build, right), 1e-4)
      << right << " of " << kBatch << " right" << others;
}

TEST(Diagnosis, RepeatsBitForBit) {
  truth::Case request = case_of(kFoundAlone[0]);
  request.seconds = 12;
  const SealedCase sealed(request);
  const Diagnosis first = sealed.diagnosed(), second = sealed.diagnosed();
  ASSERT_FALSE(first.causes.empty());
  ASSERT_EQ(first.causes.size(), second.causes.size());
  for (std::size_t i = 0; i < first.causes.size(); ++i)
    EXPECT_EQ(first.causes[i].parameters[0].value, second.causes[i].parameters[0].value);
  EXPECT_EQ(first.held_out.gain, second.held_out.gain);
}

TEST(DataInWhichNothingMoves, AreRefused) {
  const configuration::Rig rig = rig_file_of("tower");
  diagnosis::Run still;
  still.name = "still.csv";
  still.period_s = 0.01;
  still.command_v.resize(2000);
  still.cable_m.assign(2000, 1.0);
  for (auto& values : still.measured) values.assign(2000, 0.3);
  EXPECT_THROW((void)diagnose(rig, {still}, {}), DataError);
}

}  // namespace
}  // namespace crane::diagnosis::score
