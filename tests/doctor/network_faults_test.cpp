/// Faults of a network between two hosts (network namespaces with a veth pair), and the findings of the
/// doctor.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/socket.h>

#include <algorithm>
#include <functional>
#include <thread>

#include "doctor/interfaces.hpp"
#include "finding_lines.hpp"

namespace crane::doctor {
namespace {

using hosts::Answer;
using hosts::Running;
using hosts::TwoHosts;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class OnTwoHosts : public testing::Test {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    ASSERT_TRUE(hosts_.ok()) << "cannot make network namespaces with `ip netns`";
  }
  [[nodiscard]] Answer far(const std::string& options) const {
    return hosts_.on_far("doctor --net --json " + options);
  }
  [[nodiscard]] Answer near(const std::string& options) const {
    return hosts_.on_near("doctor --net --json " + options);
  }
  TwoHosts hosts_;
};

TEST_F(OnTwoHosts, ReportsThatNobodyPublishes) {
  const auto answer = far("--duration 0.5");
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_THAT(lines(answer),
              Contains(HasSubstr("nobody_publishes: nobody publishes for crane 'crane' in domain 0 on "
                                 "127.0.0.1, and no other crane is found: start one with `crane up`")));
}

TEST_F(OnTwoHosts, ReportsAnAddressOfAnotherComputerAndAnInterfaceThatIsDown) {
  EXPECT_THAT(lines(far("--interface 10.99.0.1")),
              Contains(HasSubstr("interface_unknown: --interface 10.99.0.1 is no "
                                 "address of this computer: choose one of")));
  hosts_.unplug_far();
  const auto down = far("--interface " + std::string{TwoHosts::kFar});
  EXPECT_EQ(down.exit_code, 1);
  EXPECT_THAT(lines(down), Contains(HasSubstr("interface_down")));
}

/// A doctor that hears nobody listens for 8.5 s. This test needs only its findings about interfaces.
TEST_F(OnTwoHosts, BlockedMulticastIsFound) {
  const auto found = [&] {
    const hosts::OnHost far{hosts_.far()};
    return lines(judge_interfaces({TwoHosts::kFar}, false, own_interfaces(), try_multicast));
  };
  EXPECT_THAT(found(), Contains(HasSubstr("multicast passes")));
  const std::string firewall = "ip netns exec " + hosts_.far() + " iptables -A INPUT -d 239.255.0.1 -j DROP";
  const auto dropping = hosts::run(firewall);
  ASSERT_EQ(dropping.exit_code, 0) << dropping.errors;
  EXPECT_THAT(found(), Contains(HasSubstr("multicast_blocked")));
  ASSERT_EQ(
      hosts::run("ip -n " + hosts_.far() + " link set " + hosts_.far_device() + " multicast off").exit_code,
      0);
  EXPECT_THAT(found(), Contains(HasSubstr("multicast_refused")));
}

bool has(const std::vector<std::string>& all, const std::string& text) {
  return std::ranges::any_of(all, [&](const auto& line) { return line.find(text) != std::string::npos; });
}

/// Repeats the doctor until the pair of interfaces has a carrier and the doctor observes the started stack.
std::vector<std::string> until_heard(const std::function<Answer()>& ask) {
  std::vector<std::string> all;
  for (int i = 0; i < 20; ++i) {
    all = lines(ask());
    if (has(all, "multicast passes") && !has(all, "nobody publishes")) break;
  }
  return all;
}

TEST_F(OnTwoHosts, TheWrongDomainOrCraneIsFoundFromTheOtherHost) {
  const Running stack{hosts_.near(),
                      {"up", "--priority", "0", "--insecure", "--no-black-box", "--domain", "87", "--crane",
                       "north", "--interface", TwoHosts::kNear}};
  const std::string interface = " --interface " + std::string{TwoHosts::kFar};
  const auto right = until_heard([&] { return far("--domain 87 --crane north" + interface); });
  EXPECT_THAT(right, Contains(HasSubstr("multicast passes")));
  EXPECT_THAT(right, Not(Contains(HasSubstr("nobody publishes"))));
  EXPECT_THAT(lines(far("--domain 88 --crane north" + interface)),
              Contains(testing::AllOf(HasSubstr("wrong_domain"),
                                      HasSubstr("of crane 'north' announces itself from 10.77.0.1"),
                                      HasSubstr("add --domain 87"))));
  EXPECT_THAT(lines(far("--domain 87 --crane south" + interface)),
              Contains(testing::AllOf(HasSubstr("wrong_crane"), HasSubstr("add --crane north"))));
  // On the host of the crane, the doctor also reads the command lines of the processes.
  EXPECT_THAT(lines(near("--domain 87 --crane north --interface 127.0.0.1")),
              Contains(testing::AllOf(HasSubstr("wrong_interface"), HasSubstr("add --interface 10.77.0.1"))));
}

TEST_F(OnTwoHosts, DatagramsLostInAFullBufferAreCounted) {
  std::thread{[&] {  // a separate thread, because setns() moves the calling thread
    const int space = ::open(("/run/netns/" + hosts_.far()).c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_EQ(::setns(space, CLONE_NEWNET), 0);
    ::close(space);
    const int receiver = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const int sender = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof to;
    const int small = 2048;
    ASSERT_EQ(::setsockopt(receiver, SOL_SOCKET, SO_RCVBUF, &small, sizeof small), 0);
    ASSERT_EQ(::bind(receiver, reinterpret_cast<const sockaddr*>(&to), size), 0);
    ASSERT_EQ(::getsockname(receiver, reinterpret_cast<sockaddr*>(&to), &size), 0);
    const std::array<char, 1000> bytes{};
    for (int i = 0; i < 100; ++i)
      ::sendto(sender, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), size);
    ::close(sender);
    ::close(receiver);
  }}
      .join();
  const auto answer = hosts_.on_far("doctor --rt --json --duration 0.5");
  EXPECT_THAT(lines(answer), Contains(HasSubstr("datagrams_lost")));
}

}  // namespace
}  // namespace crane::doctor
