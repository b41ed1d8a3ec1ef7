// A monitor or a dashboard on another host: two network namespaces connected by a veth pair. The loop runs on
// Cyclone DDS in one of them, the tools on Fast DDS in the other; discovery by multicast, and by unicast
// peers only. With a Discovery Server of Fast DDS, the loop runs on Fast DDS, too.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

#include "../recording/temporary_directory.hpp"
#include "two_hosts.hpp"

namespace crane::stack {
namespace {

using namespace std::chrono_literals;
using hosts::Answer;
using hosts::Running;
using hosts::TwoHosts;

std::vector<std::string> joined(std::vector<std::string> first, const std::vector<std::string>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Complete HTTP answer of a server, requested from a host; empty: no answer.
std::string ask(const std::string& host, const char* address, std::uint16_t port,
                const std::string& request) {
  std::string answer;
  std::thread{[&] {  // a separate thread, because setns() moves the calling thread
    const int space = ::open(("/run/netns/" + host).c_str(), O_RDONLY | O_CLOEXEC);
    if (space < 0 || ::setns(space, CLONE_NEWNET) != 0) return;
    ::close(space);
    const int connection = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    ::inet_pton(AF_INET, address, &to.sin_addr);
    std::array<char, 4096> buffer{};
    if (::connect(connection, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0 &&
        ::send(connection, request.data(), request.size(), MSG_NOSIGNAL) ==
            static_cast<ssize_t>(request.size()))
      for (ssize_t n = 0; (n = ::recv(connection, buffer.data(), buffer.size(), 0)) > 0;)
        answer.append(buffer.data(), static_cast<std::size_t>(n));
    ::close(connection);
  }}
      .join();
  return answer;
}

constexpr std::uint16_t kPort = 8765;

std::string get(const std::string& path, const char* address, const std::string& more = "") {
  return "GET " + path + " HTTP/1.1\r\nHost: " + address + "\r\nConnection: close\r\n" + more + "\r\n";
}
std::string post(const std::string& path, const char* address, const std::string& body) {
  return "POST " + path + " HTTP/1.1\r\nHost: " + address +
         "\r\nConnection: close\r\nContent-Type: application/json\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\n\r\n" + body;
}

/// Repeats the request until the answer contains `wanted`. @return the last answer
std::string ask_until(const std::string& host, const char* address, const std::string& request,
                      const std::string& wanted) {
  constexpr int kTries = 300;
  std::string answer;
  for (int i = 0; i < kTries && answer.find(wanted) == std::string::npos; ++i) {
    if (i > 0) std::this_thread::sleep_for(100ms);
    answer = ask(host, address, kPort, request);
  }
  return answer;
}

struct Discovery {
  std::string name;
  std::vector<std::string> stack_options, tool_options;
  bool secured = false;
  bool by_server = false;
};
void PrintTo(const Discovery& discovery, std::ostream* out) { *out << discovery.name; }

class FromAnotherHost : public testing::TestWithParam<Discovery> {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    ASSERT_TRUE(hosts.ok()) << "cannot make network namespaces with `ip netns`";
    if (GetParam().secured) {
      const auto made = hosts.on_far("keys make " + keys());
      ASSERT_EQ(made.exit_code, 0) << made.errors;
    }
    if (GetParam().by_server) start_server();
  }
  [[nodiscard]] std::string keys() const { return (directory / "keys").string(); }
  /// Options of a command that only reads.
  [[nodiscard]] std::string tool_options() const {
    std::string text;
    for (const auto& option : GetParam().tool_options) text += " " + option;
    return text + (GetParam().secured ? " --secure " + keys() : "");
  }
  /// Options of a command that also writes.
  [[nodiscard]] std::vector<std::string> writing(const std::vector<std::string>& options) const {
    return joined(options, GetParam().secured ? std::vector<std::string>{"--secure", keys()}
                                              : std::vector<std::string>{"--insecure"});
  }
  [[nodiscard]] std::vector<std::string> up() const {
    return writing(joined({"up", "--priority", "0"}, GetParam().stack_options));
  }
  /// During the start of the stack the tool finds no process, or only the first processes.
  Answer patiently(const std::string& command, const std::vector<std::string>& wanted = {}) {
    const auto complete = [&](const Answer& answer) {
      return answer.exit_code == 0 && std::all_of(wanted.begin(), wanted.end(), [&](const std::string& text) {
               return answer.output.find(text) != std::string::npos;
             });
    };
    Answer answer;
    for (int i = 0; i < 10 && !complete(answer); ++i)
      answer = hosts.on_far(command + (GetParam().by_server ? "" : " --dds fastdds") + tool_options());
    return answer;
  }
  /// Ten processes with keys occupy two cores while they find each other. A dashboard waits 2 s for an answer
  /// of the supervisor and therefore starts when the stack is complete.
  void await_locked_crane() {
    const auto status = patiently("status --json", {"LOCKED"});
    ASSERT_EQ(status.exit_code, 0) << status.errors;
  }
  TwoHosts hosts;
  recording::TemporaryDirectory directory;

 private:
  /// As docs/other_hosts.md describes: a copy of the profile with the address of the host.
  void start_server() {
    constexpr std::string_view kAddress = "192.0.2.7";
    auto profile = recording::contents_of(CRANE_SERVER_PROFILE);
    for (auto at = profile.find(kAddress); at != std::string::npos; at = profile.find(kAddress))
      profile.replace(at, kAddress.size(), TwoHosts::kNear);
    const auto file = directory / "server.xml";
    std::ofstream{file} << profile;
    server_.emplace(hosts.near(), "fast-discovery-server", std::vector<std::string>{"-x", file.string()});
  }
  std::optional<hosts::RunningProgram> server_;
};

TEST_P(FromAnotherHost, StatusAndTopicsAreSeen) {
  const Running stack{hosts.near(), up()};
  const std::string vendor = GetParam().by_server ? "fastdds" : "cyclone";
  const auto status = patiently("status --json", {"supervisor", "friction_compensation", vendor});
  ASSERT_EQ(status.exit_code, 0) << status.errors;
  const auto json = nlohmann::json::parse(status.output);
  EXPECT_THAT(json.dump(),
              testing::AllOf(testing::HasSubstr("supervisor"), testing::HasSubstr("friction_compensation"),
                             testing::HasSubstr(vendor)));
  EXPECT_EQ(json.at("insecure"), !GetParam().secured);
  const auto echo = patiently("topic echo crane/state --count 3 --json");
  ASSERT_EQ(echo.exit_code, 0) << echo.errors;
  EXPECT_THAT(echo.output, testing::HasSubstr("trolley_position_m"));
  const auto rate = patiently("topic hz crane/state --duration 2 --json");
  ASSERT_EQ(rate.exit_code, 0) << rate.errors;
  EXPECT_THAT(rate.output, testing::HasSubstr("lost"));
}

TEST_P(FromAnotherHost, ADashboardOfItsOwnShowsTheCraneAndStopsIt) {
  const Running stack{hosts.near(), up()};
  await_locked_crane();
  const Running dashboard{hosts.far(), writing(joined({"dashboard"}, GetParam().tool_options))};
  constexpr const char* kHere = "127.0.0.1";
  EXPECT_THAT(ask_until(hosts.far(), kHere, get("/", kHere), "200 OK"), testing::HasSubstr("<title>"));
  EXPECT_THAT(ask_until(hosts.far(), kHere, get("/api/situation", kHere), "\"LOCKED\""),
              testing::HasSubstr("\"LOCKED\""));
  EXPECT_THAT(ask(hosts.far(), kHere, kPort, post("/api/request", kHere, R"({"kind":"estop"})")),
              testing::HasSubstr(R"("accepted":true)"));
  EXPECT_THAT(ask_until(hosts.far(), kHere, get("/api/situation", kHere), "\"OPERATOR_ESTOP\""),
              testing::HasSubstr("\"ESTOP\""));
}

TEST_P(FromAnotherHost, ThePageOfTheCranesHostShowsAndStopsWithTheTokenOnly) {
  const auto token = directory / "token";
  const Running stack{hosts.near(), up()};
  await_locked_crane();
  const Running dashboard{
      hosts.near(),
      writing(joined({"dashboard", "--listen", TwoHosts::kNear, "--operator-token", token.string()},
                     GetParam().stack_options))};
  const auto from_far = [&](const std::string& request, const std::string& wanted) {
    return ask_until(hosts.far(), TwoHosts::kNear, request, wanted);
  };
  EXPECT_THAT(from_far(get("/api/situation", TwoHosts::kNear), "\"LOCKED\""),
              testing::HasSubstr("\"LOCKED\""));
  EXPECT_THAT(from_far(get("/api/about", TwoHosts::kNear), "may_operate"),
              testing::HasSubstr(R"("may_operate":false)"));
  EXPECT_THAT(from_far(post("/api/request", TwoHosts::kNear, R"({"kind":"estop"})"), "HTTP"),
              testing::HasSubstr("403"));
  auto key = recording::contents_of(token);
  while (!key.empty() && key.back() == '\n') key.pop_back();
  EXPECT_THAT(
      from_far(get("/api/about", TwoHosts::kNear, "Authorization: Bearer " + key + "\r\n"), "may_operate"),
      testing::HasSubstr(R"("may_operate":true)"));
}

TEST(AnotherHost, WithoutCarrierIsNamedAndRefused) {
  if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
  const TwoHosts hosts;
  ASSERT_TRUE(hosts.ok());
  hosts.unplug_far();
  for (const std::string vendor : {"cyclone", "fastdds"}) {
    const auto refused =
        hosts.on_far("status --domain 84 --dds " + vendor + " --interface " + TwoHosts::kFar);
    EXPECT_EQ(refused.exit_code, 1) << refused.errors;
    EXPECT_THAT(refused.errors, testing::HasSubstr("the interface of 10.77.0.2 is down or has no carrier"));
  }
}

class LostInterface : public testing::TestWithParam<const char*> {};

TEST_P(LostInterface, DoesNotKeepAStackFromEnding) {
  if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
  const TwoHosts hosts;
  ASSERT_TRUE(hosts.ok());
  const std::vector<std::string> at{"--domain", "84", "--interface", TwoHosts::kNear, "--dds", GetParam()};
  Running stack{hosts.near(), joined({"up", "--priority", "0", "--no-black-box", "--insecure"}, at)};
  Answer status;
  for (int i = 0; i < 10 && status.exit_code != 0; ++i)
    status = hosts.on_near(std::string{"status --domain 84 --interface "} + TwoHosts::kNear);
  ASSERT_EQ(status.exit_code, 0) << status.errors;
  hosts.remove_link();
  EXPECT_TRUE(stack.interrupted(20s));
}

INSTANTIATE_TEST_SUITE_P(Vendors, LostInterface, testing::Values("cyclone", "fastdds"),
                         [](const auto& vendor) { return std::string{vendor.param}; });

using ByServer = FromAnotherHost;

TEST_P(ByServer, WithoutMulticastTheServerIsNeeded) {
  for (const auto& host : {hosts.near(), hosts.far()}) {
    const auto device = host == hosts.near() ? hosts.near_device() : hosts.far_device();
    ASSERT_EQ(hosts::run("ip -n " + host + " link set " + device + " multicast off").exit_code, 0);
  }
  const Running stack{hosts.near(), up()};
  const auto status = patiently("status --json", {"LOCKED"});
  EXPECT_EQ(status.exit_code, 0) << status.errors;
  const auto without = hosts.on_far("status --domain 80 --interface " + std::string{TwoHosts::kFar});
  EXPECT_EQ(without.exit_code, 1) << without.output;
}

using WithKeys = FromAnotherHost;

TEST_P(WithKeys, AnOperatorIsObeyedAndAHostWithoutKeysReceivesNothing) {
  const Running stack{hosts.near(), up()};
  await_locked_crane();
  const auto reset = patiently("reset");
  EXPECT_EQ(reset.exit_code, 0) << reset.errors;
  const auto without =
      hosts.on_far("status --dds fastdds --domain 83 --interface " + std::string{TwoHosts::kFar});
  EXPECT_EQ(without.exit_code, 1) << without.errors;
  EXPECT_THAT(without.errors, testing::HasSubstr("--secure"));
}

TEST_P(WithKeys, AStackOnAnOpenNetworkIsRefusedWithoutThem) {
  const auto refused = hosts.on_far("up --interface " + std::string{TwoHosts::kFar});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors,
              testing::AllOf(testing::HasSubstr("crane keys make"), testing::HasSubstr("--insecure")));
}

std::vector<std::string> on(const char* domain, const char* address) {
  return {"--domain", domain, "--interface", address};
}
const Discovery kSecured{"secured", on("83", TwoHosts::kNear), on("83", TwoHosts::kFar), true};
const Discovery kMulticast{"by_multicast", on("81", TwoHosts::kNear), on("81", TwoHosts::kFar)};
const Discovery kPeers{"by_unicast_peers", joined(on("82", TwoHosts::kNear), {"--peer", TwoHosts::kFar}),
                       joined(on("82", TwoHosts::kFar), {"--peer", TwoHosts::kNear})};
const std::vector<std::string> kServerOptions{"--dds", "fastdds", "--discovery-server", TwoHosts::kNear};
const Discovery kServer{"by_discovery_server", joined(on("80", TwoHosts::kNear), kServerOptions),
                        joined(on("80", TwoHosts::kFar), kServerOptions), false, true};
INSTANTIATE_TEST_SUITE_P(Server, ByServer, testing::Values(kServer),
                         [](const auto& discovery) { return discovery.param.name; });
INSTANTIATE_TEST_SUITE_P(Secured, WithKeys, testing::Values(kSecured),
                         [](const auto& discovery) { return discovery.param.name; });
INSTANTIATE_TEST_SUITE_P(Discovery, FromAnotherHost, testing::Values(kMulticast, kPeers, kServer, kSecured),
                         [](const auto& discovery) { return discovery.param.name; });

}  // namespace
}  // namespace crane::stack
