// A monitor on another host: two network namespaces joined by a veth pair, the loop on Cyclone DDS in one,
// the tools on Fast DDS in the other, found by multicast and by unicast peers only.
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "../recording/temporary_directory.hpp"
#include "stack/child_processes.hpp"

namespace crane::stack {
namespace {

using namespace std::chrono_literals;

struct Answer {
  int exit_code = -1;
  std::string output;
};

Answer run(const std::string& command) {
  Answer answer;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return answer;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    answer.output.append(buffer.data(), n);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) answer.exit_code = WEXITSTATUS(status);
  return answer;
}

/// Two hosts of our own, gone with the object.
class TwoHosts {
 public:
  TwoHosts()
      : near_{"crane_near_" + std::to_string(::getpid())}, far_{"crane_far_" + std::to_string(::getpid())} {
    const std::string id = std::to_string(::getpid());
    ok_ = run("ip netns add " + near_).exit_code == 0 && run("ip netns add " + far_).exit_code == 0 &&
          run("ip link add cn" + id + " netns " + near_ + " type veth peer name cf" + id + " netns " + far_)
                  .exit_code == 0 &&
          run("ip -n " + near_ + " addr add " + kNear + "/24 dev cn" + id).exit_code == 0 &&
          run("ip -n " + far_ + " addr add " + kFar + "/24 dev cf" + id).exit_code == 0 &&
          run("ip -n " + near_ + " link set cn" + id + " up").exit_code == 0 &&
          run("ip -n " + far_ + " link set cf" + id + " up").exit_code == 0 &&
          run("ip -n " + near_ + " link set lo up").exit_code == 0 &&
          run("ip -n " + far_ + " link set lo up").exit_code == 0;
  }
  ~TwoHosts() {
    run("ip netns del " + near_);
    run("ip netns del " + far_);
  }
  TwoHosts(const TwoHosts&) = delete;
  TwoHosts& operator=(const TwoHosts&) = delete;

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] const std::string& near() const { return near_; }
  [[nodiscard]] Answer on_far(const std::string& arguments) const {
    return run("ip netns exec " + far_ + " " + (program_directory() / "crane").string() + " " + arguments);
  }
  static constexpr const char* kNear = "10.77.0.1";
  static constexpr const char* kFar = "10.77.0.2";

 private:
  std::string near_, far_;
  bool ok_ = false;
};

/// `crane up` on the near host; ended by Ctrl-C, as its user does.
class StackOnNearHost {
 public:
  StackOnNearHost(const TwoHosts& hosts, const std::vector<std::string>& bus) {
    std::vector<std::string> arguments{
        "ip", "netns",      "exec", hosts.near(), (program_directory() / "crane").string(),
        "up", "--priority", "0"};
    arguments.insert(arguments.end(), bus.begin(), bus.end());
    pid_ = ::fork();
    if (pid_ != 0) return;
    std::vector<char*> argv;
    for (auto& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    ::execvp("ip", argv.data());
    ::_exit(127);
  }
  ~StackOnNearHost() {
    ::kill(pid_, SIGINT);
    ::waitpid(pid_, nullptr, 0);
  }
  StackOnNearHost(const StackOnNearHost&) = delete;
  StackOnNearHost& operator=(const StackOnNearHost&) = delete;

 private:
  pid_t pid_ = 0;
};

struct Discovery {
  std::string name;
  std::vector<std::string> stack_options;
  std::string tool_options;
  bool secured = false;
};

class FromAnotherHost : public testing::TestWithParam<Discovery> {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    ASSERT_TRUE(hosts.ok()) << "cannot make network namespaces with `ip netns`";
    if (GetParam().secured) {
      const auto made = hosts.on_far("keys make " + keys());
      ASSERT_EQ(made.exit_code, 0) << made.output;
    }
  }
  [[nodiscard]] std::string keys() const { return (directory / "keys").string(); }
  [[nodiscard]] std::string tool_options() const {
    return GetParam().tool_options + (GetParam().secured ? " --secure " + keys() : "");
  }
  [[nodiscard]] std::vector<std::string> stack_options() const {
    auto options = GetParam().stack_options;
    if (GetParam().secured)
      options.insert(options.end(), {"--secure", keys()});
    else
      options.emplace_back("--insecure");
    return options;
  }
  /// Until the stack has come up the tool says that nobody is there, or sees the first of its processes only.
  Answer patiently(const std::string& command, const std::vector<std::string>& wanted = {}) {
    const auto complete = [&](const Answer& answer) {
      return answer.exit_code == 0 && std::all_of(wanted.begin(), wanted.end(), [&](const std::string& text) {
               return answer.output.find(text) != std::string::npos;
             });
    };
    Answer answer;
    for (int i = 0; i < 10 && !complete(answer); ++i)
      answer = hosts.on_far(command + " --dds fastdds " + tool_options());
    return answer;
  }
  TwoHosts hosts;
  recording::TemporaryDirectory directory;
};

TEST_P(FromAnotherHost, StatusAndTopicsAreSeen) {
  const StackOnNearHost stack{hosts, stack_options()};
  const auto status = patiently("status --json", {"supervisor", "friction_compensation", "cyclone"});
  ASSERT_EQ(status.exit_code, 0) << status.output;
  const auto json = nlohmann::json::parse(status.output);
  EXPECT_THAT(json.dump(),
              testing::AllOf(testing::HasSubstr("supervisor"), testing::HasSubstr("friction_compensation"),
                             testing::HasSubstr("cyclone")));
  EXPECT_EQ(json.at("insecure"), !GetParam().secured);
  const auto echo = patiently("topic echo crane/state --count 3 --json");
  ASSERT_EQ(echo.exit_code, 0) << echo.output;
  EXPECT_THAT(echo.output, testing::HasSubstr("trolley_position_m"));
  const auto rate = patiently("topic hz crane/state --duration 2 --json");
  ASSERT_EQ(rate.exit_code, 0) << rate.output;
  EXPECT_THAT(rate.output, testing::HasSubstr("lost"));
}

using WithKeys = FromAnotherHost;

TEST_P(WithKeys, AnOperatorIsObeyedAndAHostWithoutKeysHearsNothing) {
  const StackOnNearHost stack{hosts, stack_options()};
  const auto status = patiently("status --json", {"LOCKED"});
  ASSERT_EQ(status.exit_code, 0) << status.output;
  const auto reset = patiently("reset");
  EXPECT_EQ(reset.exit_code, 0) << reset.output;
  const auto without = hosts.on_far("status --dds fastdds " + GetParam().tool_options);
  EXPECT_EQ(without.exit_code, 1) << without.output;
  EXPECT_THAT(without.output, testing::HasSubstr("--secure"));
}

TEST_P(WithKeys, AStackOnAnOpenNetworkIsRefusedWithoutThem) {
  const auto refused = hosts.on_far("up --interface " + std::string{TwoHosts::kFar});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.output,
              testing::AllOf(testing::HasSubstr("crane keys make"), testing::HasSubstr("--insecure")));
}

const Discovery kSecured{"secured",
                         {"--domain", "83", "--interface", TwoHosts::kNear},
                         std::string{"--domain 83 --interface "} + TwoHosts::kFar,
                         true};
INSTANTIATE_TEST_SUITE_P(Secured, WithKeys, testing::Values(kSecured),
                         [](const auto& discovery) { return discovery.param.name; });
INSTANTIATE_TEST_SUITE_P(Discovery, FromAnotherHost,
                         testing::Values(Discovery{"by_multicast",
                                                   {"--domain", "81", "--interface", TwoHosts::kNear},
                                                   std::string{"--domain 81 --interface "} + TwoHosts::kFar},
                                         Discovery{"by_unicast_peers",
                                                   {"--domain", "82", "--interface", TwoHosts::kNear,
                                                    "--peer", TwoHosts::kFar},
                                                   std::string{"--domain 82 --interface "} + TwoHosts::kFar +
                                                       " --peer " + TwoHosts::kNear}),
                         [](const auto& discovery) { return discovery.param.name; });

}  // namespace
}  // namespace crane::stack
