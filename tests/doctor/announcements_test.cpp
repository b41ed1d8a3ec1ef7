#include "doctor/announcements.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <random>

namespace crane::doctor {
namespace {

using Bytes = std::vector<std::uint8_t>;

void append(Bytes& bytes, const std::string& text) { bytes.insert(bytes.end(), text.begin(), text.end()); }
void append_16(Bytes& bytes, std::size_t value) {
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
}
void append_32(Bytes& bytes, std::size_t value) {
  append_16(bytes, value & 0xFFFFU);
  append_16(bytes, value >> 16U);
}

/// SPDP as RTPS 2.5 prints it (8.3.7.3, 9.4.5.4, 9.6.3): INFO_TS, then DATA with a parameter list.
Bytes datagram_with(const std::string& user_data, bool key_hash = false) {
  Bytes list;
  append_16(list, 0x15);  // PID_PROTOCOL_VERSION
  append_16(list, 4);
  append_32(list, 0x0102);
  auto padded = user_data;
  padded.resize((user_data.size() + 3) / 4 * 4);
  append_16(list, 0x2C);  // PID_USER_DATA
  append_16(list, 4 + padded.size());
  append_32(list, user_data.size());
  append(list, padded);
  append_32(list, 1);  // PID_SENTINEL
  Bytes bytes;
  append(bytes, std::string("RTPS\x02\x01\x01\x10", 8));
  bytes.resize(20);  // GUID prefix
  bytes.insert(bytes.end(), {0x09, 0x01, 8, 0, 1, 2, 3, 4, 5, 6, 7, 8});
  bytes.insert(bytes.end(), {0x15, static_cast<std::uint8_t>(key_hash ? 0x07 : 0x05)});
  append_16(bytes, 20 + (key_hash ? 24 : 0) + 4 + list.size());
  bytes.insert(bytes.end(), {0, 0, 16, 0, 0, 1, 0, 0xC7, 0, 1, 0, 0xC2, 0, 0, 0, 0, 1, 0, 0, 0});
  if (key_hash) {  // inline QoS: PID_KEY_HASH, PID_SENTINEL
    bytes.insert(bytes.end(), {0x70, 0, 16, 0});
    bytes.resize(bytes.size() + 16, 0xAB);
    bytes.insert(bytes.end(), {1, 0, 0, 0});
  }
  bytes.insert(bytes.end(), {0x00, 0x03, 0, 0});  // PL_CDR_LE
  bytes.insert(bytes.end(), list.begin(), list.end());
  return bytes;
}

constexpr const char* kSaid = "crane messages=3 crane=big one participant=crane_plant";

TEST(Announcements, AreReadFromADiscoveryDatagram) {
  for (const bool key_hash : {false, true}) {
    const auto found = announcement_in(datagram_with(kSaid, key_hash));
    ASSERT_TRUE(found) << key_hash;
    EXPECT_EQ(*found, (bus::Announcement{3, "big one", "crane_plant"}));
  }
}

TEST(Announcements, OfOtherProgramsAreIgnored) {
  EXPECT_FALSE(announcement_in(datagram_with("somebody else's data")));
  EXPECT_FALSE(announcement_in(datagram_with("")));
  EXPECT_FALSE(announcement_in({}));
}

TEST(Announcements, TruncatedOrChangedAtAnyByteCauseNoError) {
  const auto whole = datagram_with(kSaid, true);
  for (std::size_t length = 0; length < whole.size() - 4; ++length) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    if (const auto found = announcement_in(cut)) {
      EXPECT_EQ(found->participant, "crane_plant");
    }
  }
  const auto seed = std::random_device{}();
  std::cout << "seed " << seed << '\n';
  std::mt19937 random{seed};
  constexpr int kTries = 200'000;
  for (int i = 0; i < kTries; ++i) {
    auto changed = whole;
    for (int changes = 0; changes < 4; ++changes)
      changed[random() % changed.size()] = static_cast<std::uint8_t>(random());
    if (const auto found = announcement_in(changed)) {
      EXPECT_LE(found->participant.size(), changed.size());
    }
  }
}

}  // namespace
}  // namespace crane::doctor
