#include "crc32c.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string_view>
#include <vector>

namespace crane::bus {
namespace {

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(Crc32c, GivesTheCheckValueOfTheCatalogue) {
  EXPECT_EQ(crc32c(bytes_of("123456789")), 0xE3069283U);
  EXPECT_EQ(crc32c_portable(bytes_of("123456789")), 0xE3069283U);
}

TEST(Crc32c, GivesTheValuesOfRfc3720) {  // appendix B.4
  const std::vector<std::uint8_t> zeros(32, 0);
  const std::vector<std::uint8_t> ones(32, 0xFF);
  EXPECT_EQ(crc32c(zeros), 0x8A9136AAU);
  EXPECT_EQ(crc32c(ones), 0x62A8AB43U);
}

TEST(Crc32c, OfNothingIsZero) { EXPECT_EQ(crc32c({}), 0U); }

TEST(Crc32c, InstructionAndBoostAgreeAtEveryLengthAndAlignment) {
  std::mt19937 random{20240611};
  std::vector<std::uint8_t> bytes(300);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  for (std::size_t start = 0; start < 16; ++start)
    for (std::size_t length = 0; start + length <= bytes.size(); ++length) {
      const auto part = std::span<const std::uint8_t>{bytes}.subspan(start, length);
      ASSERT_EQ(crc32c(part), crc32c_portable(part)) << "start " << start << ", length " << length;
    }
}

}  // namespace
}  // namespace crane::bus
