/// Keys of a terminal as a stick: what each byte means, and how long a key acts.
#include "cli/stick_keys.hpp"

#include <gtest/gtest.h>

#include <random>
#include <utility>

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
  keys.take("\x1b[A", now_s + StickKeys::kFirst_s);
  EXPECT_NE(keys.take_step(), std::nullopt) << "the key was released in between";
}

TEST(StickKeys, HeldDownWhileInchingAreOneStepAlsoOnASlowConnection) {
  StickKeys keys{false, true};
  keys.take("\x1b[A", 1);
  ASSERT_NE(keys.take_step(), std::nullopt);
  for (double now_s = 1.5; now_s < 10; now_s += 0.4) keys.take("\x1b[A", now_s);
  EXPECT_EQ(keys.take_step(), std::nullopt);
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

/// A terminal and the passes that read it. Time advances only in pass().
class Terminal {
 public:
  explicit Terminal(bool inching = false) : keys{false, inching} { pass(0); }

  void type(std::string_view bytes) { waiting_ += bytes; }
  void type(std::string_view key, int times) {
    for (int i = 0; i < times; ++i) waiting_ += key;
  }
  /// Reads all that waits, `after_s` after the previous pass.
  void pass(double after_s = kPass_s) {
    now_s += after_s;
    keys.take_pass(std::exchange(waiting_, {}), now_s);
  }
  [[nodiscard]] Deflection deflection() const { return keys.deflection(now_s); }
  /// Time for which the stick stays deflected from now on, with passes and without further keys.
  double moves_s() {
    const double from_s = now_s;
    for (int i = 0; i < 200 && deflection() != kReleased; ++i) pass();
    return now_s - from_s;
  }

  static constexpr double kPass_s = 0.02;
  double now_s = 1;
  StickKeys keys;

 private:
  std::string waiting_;
};

TEST(StickKeysOfATerminal, ThatAreHeldDownActWithoutAGap) {
  for (const double repeat_s : {1.0 / 60, 1.0 / 30, 1.0 / 10}) {
    Terminal terminal;
    double press_s = terminal.now_s;
    for (int i = 0, presses = 0; i < 300; ++i) {
      for (; press_s <= terminal.now_s; press_s += presses++ == 0 ? 0.5 : repeat_s)
        terminal.type("\x1b[1;2A");
      terminal.pass();
      ASSERT_EQ(terminal.deflection(), (Deflection{kMicroSpeed, 0, 0}))
          << i << ", every " << repeat_s << " s";
    }
    EXPECT_LT(terminal.moves_s(), StickKeys::kRepeat_s + 1.5 * Terminal::kPass_s);
  }
}

TEST(StickKeysOfATerminal, ThatArriveAsABurstDoNotMove) {
  Terminal terminal;
  terminal.type("\x1b[A", 1300);
  terminal.pass();
  EXPECT_EQ(terminal.moves_s(), 0);
  terminal.type("\x1b[A", 10);  // the rest of the burst, from a slow connection
  terminal.pass();
  EXPECT_EQ(terminal.moves_s(), 0);
  for (int i = 0; i < 10; ++i) terminal.pass();
  terminal.type("\x1b[A");
  terminal.pass();
  EXPECT_EQ(terminal.deflection(), (Deflection{1, 0, 0})) << "a new key acts";
}

TEST(StickKeysOfATerminal, ThatWaitedDuringAPauseDoNotMove) {
  for (const int keys : {1, 10, 150}) {
    Terminal terminal;
    terminal.type("\x1b[A", keys);
    terminal.pass(5);
    EXPECT_EQ(terminal.moves_s(), 0) << keys;
    terminal.type("\x1b[A", keys);
    terminal.pass(0.7);
    EXPECT_EQ(terminal.moves_s(), 0) << keys;
  }
}

TEST(StickKeysOfATerminal, ActAtMostUntilTheirTimeSinceThePreviousPass) {
  Terminal terminal;
  terminal.type("\x1b[A");
  terminal.pass(0.4);
  EXPECT_NE(terminal.deflection(), kReleased);
  EXPECT_LT(terminal.moves_s(), 0.2 + 1.5 * Terminal::kPass_s);
}

TEST(StickKeysOfATerminal, ReleaseWithASpaceAnywhereAmongThem) {
  for (const double pause_s : {Terminal::kPass_s, 3.0})
    for (const int after : {0, 1, 500}) {
      Terminal terminal;
      terminal.type("\x1b[A");
      terminal.pass();
      ASSERT_NE(terminal.deflection(), kReleased);
      terminal.type("\x1b[A", 300);
      terminal.type(" ");
      terminal.type("\x1b[A", after);
      terminal.pass(pause_s);
      EXPECT_TRUE(terminal.keys.take_stop());
      EXPECT_EQ(terminal.moves_s(), 0) << after << " keys after the space bar, pause " << pause_s << " s";
    }
}

TEST(StickKeysOfATerminal, EndTheProgramWithAQAnywhereAmongThem) {
  Terminal terminal;
  terminal.type("\x1b[A", 300);
  terminal.type("q\x1b[A");
  terminal.pass(3);
  EXPECT_TRUE(terminal.keys.quits());
  EXPECT_EQ(terminal.moves_s(), 0);
}

TEST(StickKeysOfATerminal, ThatWaitedChangeTheModeButCauseNoStepOrReturn) {
  Terminal terminal{true};
  terminal.type("m\x1b[Ar");
  terminal.pass(3);
  EXPECT_TRUE(terminal.keys.micro());
  EXPECT_EQ(terminal.keys.take_step(), std::nullopt);
  EXPECT_FALSE(terminal.keys.take_return());
}

TEST(StickKeysOfATerminal, ThatWereTypedBeforeTheFirstPassDoNotMove) {
  StickKeys keys;
  keys.take_pass("\x1b[A", 1);
  EXPECT_EQ(keys.deflection(1), kReleased);
}

TEST(StickKeysOfATerminal, DoNotContinueASequenceOfABacklog) {
  Terminal terminal;
  terminal.type("\x1b[1;2");
  terminal.pass(3);
  for (int i = 0; i < 10; ++i) terminal.pass();
  terminal.type("C");
  terminal.pass();
  EXPECT_EQ(terminal.deflection(), kReleased);
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
