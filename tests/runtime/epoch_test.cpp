// Start-up numbers of processes that follow each other.
#include <gtest/gtest.h>

#include "crane/runtime/process.hpp"

namespace crane::runtime {
namespace {

using std::chrono::milliseconds;
using Time = std::chrono::system_clock::time_point;

constexpr Time kMidnight{std::chrono::sys_days{std::chrono::year{2026} / 1 / 1}};

TEST(Epoch, OfAProcessThatWritesAfterAnotherOneWithinTheSameSecondIsHigher) {
  for (milliseconds into{0}; into < milliseconds{2000}; into += milliseconds{7})
    EXPECT_GT(epoch_at(kMidnight + into + kSoleWriterLook), epoch_at(kMidnight + into)) << into.count();
}

TEST(Epoch, GrowsOverTheYearsOfACraneThatIsNotSwitchedOff) {
  for (int year = 2026; year < 2038; ++year) {
    const Time new_year{std::chrono::sys_days{std::chrono::year{year} / 1 / 1}};
    EXPECT_GE(epoch_at(new_year), epoch_at(kMidnight)) << year;
  }
}

}  // namespace
}  // namespace crane::runtime
