#include "dashboard/packed_samples.hpp"

#include <gtest/gtest.h>

#include "../observation/samples.hpp"

namespace crane::dashboard {
namespace {

TEST(PackedSamples, HaveTimeLengthAndBytes) {
  const auto sample = observation::sample_of(topics::event, msg::Event{}, 0x0102030405060708);
  const auto bytes = packed({sample, sample});
  ASSERT_EQ(bytes.size(), 2 * (12 + sample->cdr.size()));
  EXPECT_EQ(bytes.substr(0, 8), "\x08\x07\x06\x05\x04\x03\x02\x01");
  EXPECT_EQ(static_cast<unsigned char>(bytes[8]), sample->cdr.size() & 0xFFU);
}

}  // namespace
}  // namespace crane::dashboard
