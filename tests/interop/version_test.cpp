// A participant whose program has another version of crane.idl is named, and all its samples are dropped.
// Domain 48.
#include "stage.hpp"

namespace crane::bus::testing {
namespace {

constexpr std::uint32_t kDomain = 48;
constexpr std::uint32_t kOwn = crane_MESSAGES_VERSION;

Options of_version(Vendor vendor, std::uint32_t version, const std::string& participant,
                   const std::string& crane = "crane") {
  auto chosen = options(vendor, kDomain, crane);
  chosen.messages_version = version;
  chosen.participant = participant;
  return chosen;
}

class OtherVersions : public ::testing::TestWithParam<VendorPair> {};

TEST_P(OtherVersions, AreNamedOnBothSidesAndTheirSamplesAreDropped) {
  Bus ours{of_version(GetParam().reader, kOwn, "ours")};
  std::optional<Bus> theirs{of_version(GetParam().writer, kOwn + 1, "theirs")};
  auto reader = ours.subscriber(topics::state);
  auto writer = theirs->publisher(topics::state);
  ASSERT_TRUE(matched(ours, writer, reader));  // the layout is the same, only the version differs
  ASSERT_TRUE(eventually(ours, [&] { return ours.other_versions().size() == 1; }));
  EXPECT_EQ(ours.other_versions().front().participant, "theirs");
  EXPECT_EQ(ours.other_versions().front().version, kOwn + 1);
  ASSERT_TRUE(eventually(ours, [&] { return theirs->other_versions().size() == 1; }));
  EXPECT_EQ(theirs->other_versions().front().version, kOwn);
  ASSERT_TRUE(writer.publish({}));
  EXPECT_TRUE(eventually(ours, [&] { return !reader.take() && reader.counts().rejected == 1; }));
  EXPECT_EQ(reader.counts().taken, 0U);
}

TEST_P(OtherVersions, OfAnotherCraneOrOfTheSameVersionAreNotNamed) {
  Bus ours{of_version(GetParam().reader, kOwn, "ours")};
  Bus same{of_version(GetParam().writer, kOwn, "same")};
  Bus elsewhere{of_version(GetParam().writer, kOwn + 1, "elsewhere", "other_crane")};
  Bus witness{of_version(GetParam().writer, kOwn + 1, "witness")};
  // The witness joined last. When it is discovered, all earlier participants have also been discovered.
  ASSERT_TRUE(eventually(ours, [&] { return !ours.other_versions().empty(); }));
  const auto reader = ours.subscriber(topics::state);
  const auto writer = same.publisher(topics::state);
  ASSERT_TRUE(matched(ours, writer, reader));
  ASSERT_EQ(ours.other_versions().size(), 1U);
  EXPECT_EQ(ours.other_versions().front().participant, "witness");
}

TEST_P(OtherVersions, AreForgottenWhenTheyEnd) {
  Bus ours{of_version(GetParam().reader, kOwn, "ours")};
  std::optional<Bus> theirs{of_version(GetParam().writer, kOwn + 1, "theirs")};
  ASSERT_TRUE(eventually(ours, [&] { return !ours.other_versions().empty(); }));
  theirs.reset();
  EXPECT_TRUE(eventually(ours, [&] { return ours.other_versions().empty(); }));
}

INSTANTIATE_TEST_SUITE_P(AllPairs, OtherVersions, kAllPairs,
                         [](const auto& test) { return name_of(test.param); });

TEST(Refusal, NamesBothVersionsAndTheRemedy) {
  EXPECT_EQ(refusal({"crane_supervisor", 2}, 1),
            "crane_supervisor has messages of version 2, this program has version 1: run programs of one "
            "release, or "
            "give each crane its own --crane or --domain");
}

}  // namespace
}  // namespace crane::bus::testing
