#include "parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>

namespace crane::diagnosis {
namespace {

TEST(ParallelFor, ExceptionDoesNotCancelNestedLoopsOfOtherIterations) {
  for (int round = 0; round < 5000; ++round) {
    std::atomic<bool> whole{true};
    EXPECT_THROW(parallel_for(8,
                              [&](std::size_t i) {
                                if (i == 7) throw std::runtime_error("wrong");
                                std::atomic<int> done = 0;
                                parallel_for(200, [&](std::size_t) { ++done; });
                                if (done != 200) whole = false;
                              }),
                 std::runtime_error);
    ASSERT_TRUE(whole) << "round " << round;
  }
}

}  // namespace
}  // namespace crane::diagnosis
