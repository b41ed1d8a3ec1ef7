/// Keys of a terminal as a stick: what each byte means, and how long a key acts.
#include "cli/stick_keys.hpp"

#include <gtest/gtest.h>

#include <random>

namespace crane::cli {
namespace {

using Deflection = std::array<double, 3>;
constexpr Deflection kReleased{};

/// Deflection immediately after these bytes.
Deflection after(std::string_view bytes) {
  StickKeys keys;
  keys.take(bytes, 1);
  return keys.deflection(1);
}

TEST(StickKeys, DeflectAnAxisEach) {
  EXPECT_EQ(after(""), kReleased);
  EXPECT_EQ(after("\x1b[A"), (Deflection{1, 0, 0}));
  EXPECT_EQ(after("\x1b[B"), (Deflection{-1, 0, 0}));
  EXPECT_EQ(after("\x1b[C"), (Deflection{0, 1, 0}));
  EXPECT_EQ(after("\x1b[D"), (Deflection{0, -1, 0}));
  EXPECT_EQ(after("\x1b[5~"), (Deflection{0, 0, -1}));
  EXPECT_EQ(after("\x1b[6~"), (Deflection{0, 0, 1}));
  EXPECT_EQ(after("\x1bOA\x1bOC"), (Deflection{1, 1, 0})) << "keys of two axes act together";
  EXPECT_EQ(after("\x1b[A\x1b[B"), (Deflection{-1, 0, 0})) << "the last key of an axis acts";
}

TEST(StickKeys, AreSlowWithShiftAndInMicroSpeed) {
  EXPECT_EQ(after("\x1b[1;2A"), (Deflection{kMicroSpeed, 0, 0}));
  EXPECT_EQ(after("\x1b[6;2~"), (Deflection{0, 0, kMicroSpeed}));
  EXPECT_EQ(after("m\x1b[D"), (Deflection{0, -kMicroSpeed, 0}));
  EXPECT_EQ(after("\x1b[Dm"), (Deflection{0, -kMicroSpeed, 0})) << "m slows a key that acts";
  EXPECT_EQ(after("mm\x1b[D"), (Deflection{0, -1, 0}));
}

TEST(StickKeys, ActUntilTheKeyboardWouldHaveRepeatedThem) {
  StickKeys keys;
  keys.take("\x1b[A", 1);
  EXPECT_NE(keys.deflection(1 + StickKeys::kFirst_s), kReleased);
  EXPECT_EQ(keys.deflection(1.001 + StickKeys::kFirst_s), kReleased);
}

TEST(StickKeys, ActShortlyAfterTheLastRepetition) {
  StickKeys keys;
  keys.take("\x1b[A", 1);
  keys.take("\x1b[A", 1.5);
  keys.take("\x1b[A", 1.53);
  EXPECT_NE(keys.deflection(1.53 + StickKeys::kRepeat_s), kReleased);
  EXPECT_EQ(keys.deflection(1.531 + StickKeys::kRepeat_s), kReleased);
}

TEST(StickKeys, OfTheOtherDirectionAreNotRepetitions) {
  StickKeys keys;
  keys.take("\x1b[A", 1);
  keys.take("\x1b[B", 1.1);
  EXPECT_EQ(keys.deflection(1.1 + StickKeys::kFirst_s), (Deflection{-1, 0, 0}));
}

TEST(StickKeys, AreReleasedByTheSpaceBar) {
  StickKeys keys;
  keys.take("\x1b[A\x1b[C", 1);
  EXPECT_EQ(keys.last_s(), 1);
  keys.take(" ", 1.01);
  EXPECT_EQ(keys.deflection(1.01), kReleased);
  EXPECT_LT(keys.last_s(), 0);
  keys.take("\x1b[A", 1.02);
  EXPECT_NE(keys.deflection(1.5), kReleased) << "the key after the space bar is a first press";
}

TEST(StickKeys, PressedWhileInchingAreOneStepEach) {
  StickKeys keys{false, true};
  keys.take("\x1b[A", 1);
  EXPECT_EQ(keys.deflection(1), kReleased);
  EXPECT_EQ(keys.take_step(), (InchingStep{.axis = 0, .direction = 1}));
  EXPECT_EQ(keys.take_step(), std::nullopt) << "a step is taken once";
  keys.take("\x1b[D", 1.1);
  EXPECT_EQ(keys.take_step(), (InchingStep{.axis = 1, .direction = -1}));
}

TEST(StickKeys, HeldDownWhileInchingAreOneStep) {
  StickKeys keys{false, true};
  keys.take("\x1b[A", 1);
  ASSERT_NE(keys.take_step(), std::nullopt);
  double now_s = 1.5;  // the keyboard repeats after half a second
  for (int i = 0; i < 100; ++i, now_s += 0.03) keys.take("\x1b[A", now_s);
  EXPECT_EQ(keys.take_step(), std::nullopt);
  keys.take("\x1b[A", now_s + StickKeys::kRepeat_s);
  EXPECT_NE(keys.take_step(), std::nullopt) << "the key was released in between";
}

TEST(StickKeys, NeverMixStepsAndDeflections) {
  StickKeys keys;
  keys.take("\x1b[Ai", 1);
  EXPECT_TRUE(keys.inching());
  EXPECT_EQ(keys.deflection(1), kReleased) << "i releases the stick";
  EXPECT_EQ(keys.take_step(), std::nullopt);
  keys.take("\x1b[Bi", 2);
  EXPECT_FALSE(keys.inching());
  EXPECT_EQ(keys.take_step(), std::nullopt) << "i discards the step";
  EXPECT_EQ(keys.deflection(2), kReleased);
}

TEST(StickKeys, ReturnToTheStopPointWithRAfterARelease) {
  StickKeys keys;
  keys.take("\x1b[Ar", 1);
  EXPECT_EQ(keys.deflection(1), kReleased);
  EXPECT_LT(keys.last_s(), 0);
  EXPECT_TRUE(keys.take_return());
  EXPECT_FALSE(keys.take_return()) << "once per key";
}

TEST(StickKeys, EndWithQ) {
  StickKeys keys;
  keys.take("\x1b[A", 1);
  EXPECT_FALSE(keys.quits());
  keys.take("xq", 1.1);
  EXPECT_TRUE(keys.quits());
}

TEST(StickKeys, MayArriveByteByByte) {
  StickKeys keys;
  for (const char byte : std::string_view{"\x1b[1;2C"}) {
    EXPECT_EQ(keys.deflection(1), kReleased);
    keys.take({&byte, 1}, 1);
  }
  EXPECT_EQ(keys.deflection(1), (Deflection{0, kMicroSpeed, 0}));
}

TEST(StickKeys, OfOtherProgramsHaveNoEffect) {
  EXPECT_EQ(after("\x1b[H\x1b[1;5A\x1b[200~abc\xC3\xA4\n"), kReleased);
  EXPECT_EQ(after("\x1b\x1b[A"), (Deflection{1, 0, 0})) << "the escape key, then an arrow";
}

TEST(StickKeys, OfRandomBytesStayWithinAFullDeflectionThatEnds) {
  constexpr unsigned kSeed = 7;
  constexpr std::string_view kBytes{"\x1b[OABCD1256;~m x"};
  std::mt19937 random{kSeed};
  StickKeys keys;
  double now_s = 0;
  for (int i = 0; i < 100'000; ++i, now_s += 0.01) {
    const char byte = kBytes[random() % kBytes.size()];
    keys.take({&byte, 1}, now_s);
    for (const double share : keys.deflection(now_s)) ASSERT_LE(std::abs(share), 1) << "seed " << kSeed;
  }
  EXPECT_EQ(keys.deflection(now_s + StickKeys::kFirst_s), kReleased);
}

}  // namespace
}  // namespace crane::cli
