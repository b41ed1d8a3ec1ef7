/// Loop on several threads: every call once, exceptions, no calls.
#include "crane/workers/for_each_on_threads.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace crane::workers {
namespace {

TEST(ForEachOnThreads, CallsEachIndexOnce) {
  for (const unsigned threads : {1U, 3U, 20U}) {
    std::vector<std::atomic<int>> calls(10);
    for_each_on_threads(calls.size(), threads, [&](std::size_t i) { ++calls[i]; });
    for (const auto& count : calls) EXPECT_EQ(count, 1) << threads << " threads";
  }
}

TEST(ForEachOnThreads, ThrowsTheExceptionOfACallAndBeginsNoFurtherCall) {
  std::atomic<std::size_t> last = 0;
  const auto fail_at_3 = [&](std::size_t i) {
    last = std::max<std::size_t>(last, i);
    if (i == 3) throw std::runtime_error("3");
  };
  EXPECT_THROW(for_each_on_threads(1000, 1, fail_at_3), std::runtime_error);
  EXPECT_EQ(last, 3U);
  EXPECT_THROW(for_each_on_threads(1000, 2, fail_at_3), std::runtime_error);
}

TEST(ForEachOnThreads, DoesNothingWithoutIndices) {
  for_each_on_threads(0, 2, [](std::size_t) { FAIL(); });
}

}  // namespace
}  // namespace crane::workers
