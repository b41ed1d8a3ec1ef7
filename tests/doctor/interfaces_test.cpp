#include "doctor/interfaces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace crane::doctor {
namespace {

using testing::HasSubstr;

const std::vector<Interface> kOwn{{"lo", "127.0.0.1", true, true, false},
                                  {"eth0", "10.0.0.5", true, true, true},
                                  {"eth1", "10.0.1.5", true, false, true},
                                  {"eth2", "10.0.2.5", false, false, true},
                                  {"eth3", "10.0.3.5", true, true, false}};

Findings judged(const std::string& address, Multicast result = Multicast::passes, bool peers = false) {
  return judge_interfaces({address}, peers, kOwn, [result](const std::string&) { return result; });
}

TEST(Interfaces, OfTheLoopBackNeedNoMulticast) {
  EXPECT_TRUE(judged("127.0.0.1", Multicast::not_heard).empty());
}

TEST(Interfaces, ThatThisComputerDoesNotHaveAreNamedWithThoseThatItHas) {
  const auto found = judged("192.168.7.7");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].code, "interface_unknown");
  EXPECT_THAT(found[0].remedy, HasSubstr("10.0.0.5 (eth0)"));
}

TEST(Interfaces, WithoutCarrierOrDownAreReported) {
  EXPECT_THAT(judged("10.0.1.5")[0].what, HasSubstr("has no carrier"));
  EXPECT_THAT(judged("10.0.2.5")[0].remedy, HasSubstr("ip link set eth2 up"));
}

TEST(Interfaces, AreAskedWhetherMulticastPasses) {
  EXPECT_EQ(judged("10.0.0.5")[0].grade, Grade::good);
  EXPECT_EQ(judged("10.0.0.5", Multicast::not_heard)[0].code, "multicast_blocked");
  EXPECT_EQ(judged("10.0.3.5")[0].code, "multicast_refused");
  EXPECT_TRUE(judged("10.0.0.5", Multicast::not_heard, true).empty()) << "peers need none";
}

}  // namespace
}  // namespace crane::doctor
