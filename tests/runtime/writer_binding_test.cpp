// Binding of a reader to a writer, as timelines. Times in milliseconds.
#include "crane/runtime/writer_binding.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "crane/runtime/process.hpp"

namespace crane::runtime {
namespace {

using Verdict = WriterBinding::Verdict;

constexpr std::int64_t ms(std::int64_t time_ms) { return time_ms * 1'000'000; }

Writer writer(std::uint8_t id, std::uint32_t epoch = 7, crane_Source source = crane_SOURCE_SUPERVISOR) {
  Writer writer;
  writer.id[0] = id;
  writer.source = source;
  writer.epoch = epoch;
  return writer;
}

/// Identifiers of matched writers.
std::vector<bus::WriterId> matched(std::initializer_list<std::uint8_t> ids) {
  std::vector<bus::WriterId> writers;
  for (const auto id : ids) writers.push_back(writer(id).id);
  return writers;
}

class Binding : public testing::Test {
 protected:
  /// The supervisor writes every 10 ms, up to and including `until_ms`.
  void supervisor_speaks_until(std::int64_t until_ms) {
    for (; now_ms_ <= until_ms; now_ms_ += 10)
      ASSERT_EQ(binding_.judge(writer(1), ms(now_ms_), matched({1})), Verdict::own);
  }
  std::int64_t now_ms_ = 0;
  WriterBinding binding_{topics::command.description};
};

TEST_F(Binding, AcceptsOnlyTheFirstPermittedWriter) {
  EXPECT_EQ(binding_.judge(writer(9, 7, crane_SOURCE_OPERATOR), ms(0), matched({9})), Verdict::foreign);
  EXPECT_FALSE(binding_.bound());
  supervisor_speaks_until(100);
  EXPECT_EQ(binding_.foreign(), 1U);
}

TEST_F(Binding, RefusesEveryOtherWriterWithAnyHeader) {
  supervisor_speaks_until(100);
  const std::vector<Writer> strangers{
      writer(2),                             // the supervisor's own header, from another DDS writer
      writer(2, 8),                          // a higher start-up number
      writer(2, 0xFFFFFFFF),                 //
      writer(2, 7, crane_SOURCE_PLANT),      //
      writer(1, 8),                          // the bound DDS writer under another start-up number
      writer(1, 7, crane_SOURCE_OPERATOR)};  // ... and as another kind of process
  for (const auto& stranger : strangers) {
    EXPECT_EQ(binding_.judge(stranger, ms(105), matched({1, 2})), Verdict::foreign);
    EXPECT_TRUE(binding_.disputed(ms(105)));
  }
  EXPECT_EQ(binding_.foreign(), strangers.size());
  EXPECT_EQ(binding_.judge(writer(1), ms(110), matched({1, 2})), Verdict::own);
}

TEST_F(Binding, DoesNotBeginWhileTwoWritersExist) {
  EXPECT_EQ(binding_.judge(writer(1), ms(0), matched({1, 2})), Verdict::foreign);
  EXPECT_EQ(binding_.judge(writer(2), ms(0), matched({1, 2})), Verdict::foreign);
  EXPECT_TRUE(binding_.disputed(ms(10)));
  EXPECT_EQ(binding_.judge(writer(1), ms(500), matched({1})), Verdict::own);  // the other writer has ended
}

TEST_F(Binding, IsDisputedByAWriterThatIsMatchedAndSilent) {
  supervisor_speaks_until(100);
  binding_.watch(ms(100), matched({1, 2}));
  EXPECT_TRUE(binding_.disputed(ms(100)));
}

TEST_F(Binding, StaysDisputedForASecondAfterTheLastDetection) {
  supervisor_speaks_until(100);
  (void)binding_.judge(writer(2), ms(100), matched({1, 2}));
  EXPECT_TRUE(binding_.disputed(ms(1099)));
  EXPECT_FALSE(binding_.disputed(ms(1101)));
}

TEST_F(Binding, PassesToANewStartOnlyAfterTheOldOneHasBeenSilent) {
  supervisor_speaks_until(100);
  EXPECT_EQ(binding_.judge(writer(2, 8), ms(299), matched({1, 2})), Verdict::foreign);
  EXPECT_EQ(binding_.judge(writer(2, 8), ms(300), matched({1, 2})), Verdict::taken_over);
  EXPECT_EQ(binding_.judge(writer(2, 8), ms(310), matched({1, 2})), Verdict::own);
  EXPECT_EQ(binding_.judge(writer(1), ms(320), matched({1, 2})),
            Verdict::foreign);  // the old writer continues
}

TEST_F(Binding, IsNotDisputedByADeadWriterThatDdsStillMatches) {
  supervisor_speaks_until(100);
  ASSERT_EQ(binding_.judge(writer(2, 8), ms(700), matched({1, 2})), Verdict::taken_over);
  binding_.watch(ms(700), matched({1, 2}));
  EXPECT_FALSE(binding_.disputed(ms(700)));
  binding_.watch(ms(800), matched({2}));  // its lease has ended
  ASSERT_EQ(binding_.judge(writer(2, 8), ms(810), matched({2})), Verdict::own);
  binding_.watch(ms(810), matched({2, 3}));  // a foreign writer joins
  EXPECT_TRUE(binding_.disputed(ms(810)));
}

/// The DDS thread that delivers the first sample of a writer can be ahead of the thread that reports the
/// match of the writer. If the binding counted matches, the topic would be disputed until the lease of the
/// killed process ends.
TEST_F(Binding, PassesToAWriterWhoseMatchIsSeenOnlyAfterItsFirstSample) {
  supervisor_speaks_until(100);
  ASSERT_EQ(binding_.judge(writer(2, 8), ms(700), matched({1})), Verdict::taken_over);
  for (std::int64_t now = 710; now < 2000; now += 10) {
    ASSERT_EQ(binding_.judge(writer(2, 8), ms(now), matched({1, 2})), Verdict::own);
    binding_.watch(ms(now), matched({1, 2}));
    ASSERT_FALSE(binding_.disputed(ms(now))) << now << " ms";
  }
}

TEST_F(Binding, RefusesAForgedSampleOfItsWriter) {
  supervisor_speaks_until(100);
  binding_.refuse_forged(writer(1), ms(105));
  EXPECT_TRUE(binding_.disputed(ms(105)));
  EXPECT_EQ(binding_.foreign(), 1U);
  EXPECT_EQ(binding_.judge(writer(1), ms(110), matched({1})), Verdict::own);
}

TEST_F(Binding, NamesBothWritersOfADisputeAndTheSilenceOfTheAcceptedOne) {
  const auto origin = [](const bus::WriterId& id) { return "origin " + std::to_string(id[0]); };
  supervisor_speaks_until(100);
  (void)binding_.judge(writer(2, 8), ms(112), matched({1, 2}));
  EXPECT_EQ(binding_.dispute(origin),
            "accepted: supervisor 7 (origin 1), silent for 12 ms; refused: supervisor 8 (origin 2)");
  binding_.watch(ms(113), matched({1, 3}));
  EXPECT_EQ(
      binding_.dispute(origin),
      "accepted: supervisor 7 (origin 1), silent for 13 ms; refused: a writer without samples (origin 3)");
  binding_.refuse_forged(writer(1), ms(114));
  EXPECT_EQ(binding_.dispute(origin),
            "accepted: supervisor 7 (origin 1), silent for 14 ms; refused: a sample that no process of this "
            "stack has sent, in the name of the accepted writer");
}

TEST(Epoch, IsRandomAndNeverZero) {
  std::set<std::uint32_t> seen;
  for (int i = 0; i < 1000; ++i) seen.insert(random_epoch());
  EXPECT_GT(seen.size(), 990U);
  EXPECT_FALSE(seen.contains(0));
}

}  // namespace
}  // namespace crane::runtime
