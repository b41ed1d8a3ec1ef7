/// A program without rights binds all UDP ports of the participants of a domain. Permitted: no further
/// process of the loop starts. Forbidden: an operator cannot stop the crane.
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

#include "../system/program_run.hpp"
#include "armed_crane.hpp"
#include "crane/bus/ports.hpp"

namespace crane::hostile {
namespace {

using system_test::run_program;

class BoundPorts {
 public:
  explicit BoundPorts(std::uint32_t domain) {
    for (auto port = bus::unicast_port(domain, 0); port < bus::unicast_port(domain, bus::most_participants());
         ++port) {
      const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
      sockaddr_in own{};
      own.sin_family = AF_INET;
      own.sin_port = htons(static_cast<std::uint16_t>(port));
      own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      if (::bind(socket, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0)
        sockets_.push_back(socket);
      else
        ::close(socket);
    }
  }
  BoundPorts(const BoundPorts&) = delete;
  BoundPorts& operator=(const BoundPorts&) = delete;
  ~BoundPorts() {
    for (const int socket : sockets_) ::close(socket);
  }
  [[nodiscard]] std::size_t count() const { return sockets_.size(); }

 private:
  std::vector<int> sockets_;
};

/// In a domain of its own: the attack prevents the start of every other crane in the domain.
class PortAttack : public ArmedCrane, public testing::WithParamInterface<const char*> {
 protected:
  static constexpr std::uint32_t kDomain = 96;
  PortAttack() : ArmedCrane{kDomain} {}
  [[nodiscard]] std::vector<std::string> arguments() const {
    return {"--domain", std::to_string(kDomain), "--crane", stack_.bus_options().crane, "--dds", GetParam()};
  }
};

TEST_P(PortAttack, DoesNotPreventAnEmergencyStop) {
  const BoundPorts attack{kDomain};
  std::cout << attack.count() << " ports bound\n";
  auto process = arguments();
  process.insert(process.end(), {"--rig", stack::find_rig("virginia_tech_tower").string()});
  const auto refused = run_program(stack::program_directory() / "crane_tracking", process);
  ASSERT_THAT(refused.errors, testing::HasSubstr("no free participant number"))
      << "the attack has no effect: this test proves nothing";
  stack_.listen(1s);
  expect_hold();
  auto estop = arguments();
  estop.insert(estop.begin(), "estop");
  const auto stopped = run_program(stack::program_directory() / "crane", estop);
  EXPECT_EQ(stopped.exit_code, 0) << stopped.errors;
  EXPECT_TRUE(
      stack_.until([this] { return stack_.observer().statuses().back().state == crane_STATE_ESTOP; }, 2s));
  stack_.listen(500ms);
  expect_no_motion();
}

INSTANTIATE_TEST_SUITE_P(OfBothVendors, PortAttack, testing::Values("cyclone", "fastdds"));

}  // namespace
}  // namespace crane::hostile
