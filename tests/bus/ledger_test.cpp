#include "crane/bus/ledger.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <random>

#include "crane/bus/bus.hpp"
#include "siphash.hpp"

namespace crane::bus {
namespace {

using ::testing::HasSubstr;

/// The vectors of the authors' reference implementation: key 00 01 ... 0f, input 00 01 ... of growing length.
TEST(SipHash, GivesTheVectorsOfItsAuthors) {
  constexpr SipKey kKey{0x0706050403020100, 0x0f0e0d0c0b0a0908};
  std::array<std::uint8_t, 15> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i);
  const std::span<const std::uint8_t> input{bytes};
  EXPECT_EQ(siphash(kKey, {}), 0x726fdb47dd0e0e31U);
  EXPECT_EQ(siphash(kKey, input.first(1)), 0x74f839c593dc67fdU);
  EXPECT_EQ(siphash(kKey, input.first(8)), 0x93f5f5799a932462U);
  EXPECT_EQ(siphash(kKey, input), 0xa129ca6149be45e5U);
}

std::vector<std::uint8_t> sample(std::uint64_t number) {
  std::vector<std::uint8_t> bytes(200);
  std::mt19937_64 random{number};
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

/// The key of a ledger is random, so the sets that the samples fall into are random too. An eighth sample in
/// one of the 16 384 sets would replace the first. With 1000 samples (0.061 per set), the probability of this
/// is 16 384 exp(-0.061) 0.061^8 / 8! = 7e-11.
TEST(LedgerTest, ContainsExactlyTheEnteredSamples) {
  const auto ledger = Ledger::create();
  constexpr std::uint64_t kEntered = 1000;
  for (std::uint64_t i = 0; i < kEntered; ++i) ledger->enter(sample(i));
  for (std::uint64_t i = 0; i < kEntered; ++i) {
    ASSERT_TRUE(ledger->contains(sample(i))) << i;
    ASSERT_FALSE(ledger->contains(sample(i + kEntered))) << i;
  }
  auto changed = sample(0);
  changed.back() ^= 1U;
  EXPECT_FALSE(ledger->contains(changed));
}

TEST(LedgerTest, ContainsNoEmptySample) {
  const auto ledger = Ledger::create();
  ledger->enter({});
  EXPECT_FALSE(ledger->contains({}));
}

TEST(LedgerTest, IsSharedThroughItsDescriptor) {
  const auto ledger = Ledger::create();
  const auto other = Ledger::open("/proc/self/fd/" + std::to_string(ledger->descriptor()));
  ledger->enter(sample(1));
  EXPECT_TRUE(other->contains(sample(1)));
  other->enter(sample(2));
  EXPECT_TRUE(ledger->contains(sample(2)));
}

TEST(LedgerTest, HasAKeyOfItsOwn) {
  const auto a = Ledger::create(), b = Ledger::create();
  a->enter(sample(1));
  EXPECT_FALSE(b->contains(sample(1)));
}

TEST(LedgerTest, CannotBeShortened) {
  const auto ledger = Ledger::create();
  EXPECT_NE(::ftruncate(ledger->descriptor(), 0), 0);
}

/// Otherwise, the messages of a program whose standard error is closed would overwrite the ledger.
TEST(LedgerTest, HasNoStandardDescriptor) {
  const int copy = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  ::close(STDERR_FILENO);
  const auto ledger = Ledger::create();
  const auto other = Ledger::open("/proc/self/fd/" + std::to_string(ledger->descriptor()));
  const bool still_closed = ::fcntl(STDERR_FILENO, F_GETFD) < 0;
  ::dup2(copy, STDERR_FILENO);
  ::close(copy);
  EXPECT_GT(ledger->descriptor(), STDERR_FILENO);
  EXPECT_GT(other->descriptor(), STDERR_FILENO);
  EXPECT_TRUE(still_closed);
}

TEST(LedgerTest, WithAnotherLayoutOrWriteAccessOfOthersIsRefusedWithTheRule) {
  const auto refusal = [](const std::string& path) -> std::string {
    try {
      (void)Ledger::open(path);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal("/nonexistent"), HasSubstr("/nonexistent"));
  EXPECT_THAT(refusal("/dev/null"), HasSubstr("regular file"));
  const auto ledger = Ledger::create();
  ASSERT_EQ(::fchmod(ledger->descriptor(), 0644), 0);
  EXPECT_THAT(refusal("/proc/self/fd/" + std::to_string(ledger->descriptor())), HasSubstr("0600"));
}

/// Two stacks on one memory network: a reader accepts the writer that has the same ledger.
TEST(LedgerOfABus, MarksSamplesOfProgramsThatWriteNoLedger) {
  const auto network = make_memory_network();
  // The wire marks samples as not delivered as sealed, as DDS does.
  set_wire(*network, [](const auto&, const void* carried, const Deliver& deliver) { deliver(carried); });
  const auto with = [&](std::shared_ptr<Ledger> its_ledger) {
    Options options;
    options.vendor = Vendor::memory;
    options.network = network;
    options.source = crane_SOURCE_SUPERVISOR;
    options.epoch = 7;
    options.ledger = std::move(its_ledger);
    return options;
  };
  const auto ledger = Ledger::create();
  Bus inside{with(ledger)}, outside{with(nullptr)}, other_stack{with(Ledger::create())};
  auto reader = inside.subscriber(topics::command);
  const auto entered = [&](Bus& from) {
    msg::Command command{};
    command.header.tick = 3;
    auto writer = from.publisher(topics::command);
    EXPECT_TRUE(writer.publish(command));
    SampleInfo info;
    EXPECT_TRUE(reader.take(&info));
    return info.entered;
  };
  EXPECT_FALSE(entered(outside));
  EXPECT_FALSE(entered(other_stack));
  EXPECT_TRUE(entered(inside));
  EXPECT_TRUE(entered(outside)) << "the same bytes as the entered sample";
}

TEST(LedgerOfABus, LeavesTopicsOfOperatorsOpen) {
  const auto network = make_memory_network();
  Options options;
  options.vendor = Vendor::memory;
  options.network = network;
  options.source = crane_SOURCE_OPERATOR;
  options.epoch = 7;
  Bus outside{options};
  options.ledger = Ledger::create();
  Bus inside{options};
  auto reader = inside.subscriber(topics::request);
  auto writer = outside.publisher(topics::request);
  ASSERT_TRUE(writer.publish({}));
  SampleInfo info;
  ASSERT_TRUE(reader.take(&info));
  EXPECT_TRUE(info.entered);
}

}  // namespace
}  // namespace crane::bus
