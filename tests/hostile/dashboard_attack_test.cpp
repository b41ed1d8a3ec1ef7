/// Attackers of the dashboard of a running crane: floods, requests without token, a killed dashboard. The
/// loop is not disturbed, nothing moves, and the operator with the token is served.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iostream>
#include <thread>

#include "../recording/temporary_directory.hpp"
#include "../system/running_stack.hpp"
#include "dashboard_attackers.hpp"
#include "stack/data_files.hpp"
#include "timer_witness.hpp"

namespace crane::hostile {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kDomain = 67;
constexpr const char* kRig = "virginia_tech_tower";
constexpr double kStill_m = 0.01;
/// 8 MB of history per busy topic, 32 MB of answers, 4 MB per viewer, and the memory of libraries.
constexpr long kLargest_kb = 400 * 1024;

class DashboardAttack : public testing::Test {
 protected:
  void SetUp() override {
    auto arguments = runtime::arguments(stack_.bus_options());
    arguments[1] = "fastdds";
    arguments.insert(arguments.end(),
                     {"--port", std::to_string(port_), "--operator-token", (directory_ / "token").string(),
                      "--rig", kRig, "--runs", made(directory_ / "runs").string()});
    stack_.children().start("dashboard", "crane_dashboard", arguments);
    ASSERT_TRUE(client_.answers(10s));
    std::getline(std::ifstream{directory_ / "token"}, token_);
  }
  static std::filesystem::path made(const std::filesystem::path& directory) {
    std::filesystem::create_directories(directory);
    recording::put_contents(directory / "no_recording.mcap", "this is none");
    return directory;
  }
  [[nodiscard]] crane_SupervisorState state() const { return stack_.observer().statuses().back().state; }
  [[nodiscard]] long resident_kb() {
    std::ifstream file{"/proc/" + std::to_string(*stack_.children().pid_of("dashboard")) + "/statm"};
    long all = 0, resident = 0;
    file >> all >> resident;
    return resident * (::sysconf(_SC_PAGESIZE) / 1024);
  }
  [[nodiscard]] std::uint64_t lost_ticks() const {
    std::uint64_t sum = 0;
    for (const auto& [name, node] : stack_.observer().nodes()) sum += node.lost_ticks;
    return sum;
  }

  /// Arms the crane. Afterwards, only pauses of the computer may cost ticks.
  void arm_and_count_ticks() {
    stack_.session().arm();
    (void)witness_.take();
    stack_.listen(1s);
    stack_.forget();
    lost_before_ = lost_ticks();
  }
  /// The loop has lost no more ticks than the pauses of the computer can cost, and the crane is still armed.
  void expect_undisturbed_loop() {
    const auto pauses = witness_.take();
    std::cout << lost_ticks() - lost_before_ << " ticks lost, " << pauses.pauses
              << " pauses of the computer\n";
    EXPECT_LE(lost_ticks(), lost_before_ + pauses.ticks * stack_.observer().nodes().size());
    const auto& states = stack_.observer().states();
    EXPECT_LE(states.back().overruns, states.front().overruns + pauses.ticks);
    for (const auto& status : stack_.observer().statuses()) ASSERT_EQ(status.state, crane_STATE_HOLD);
  }

  real_time_test::TimerWitness witness_;
  std::uint64_t lost_before_ = 0;
  recording::TemporaryDirectory directory_;
  system_test::RunningStack stack_{kDomain, kRig};
  unsigned short port_ = free_port();
  Client client_{port_};
  std::string token_;
};

TEST_F(DashboardAttack, AFloodDoesNotReachTheLoopAndTheOperatorIsHeard) {
  arm_and_count_ticks();
  {
    Attackers attackers{port_};
    stack_.listen(5s);
    std::cout << attackers.attempts() << " attempts, dashboard " << resident_kb() / 1024 << " MB\n";
    EXPECT_GT(attackers.attempts(), 100U);
    EXPECT_LT(resident_kb(), kLargest_kb);
    const auto& states = stack_.observer().states();
    expect_undisturbed_loop();
    EXPECT_NEAR(states.back().trolley_position_m, states.front().trolley_position_m, kStill_m);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(client_.post("/api/request", R"({"kind":"estop"})", token_), 200U);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 2s);
  }
  EXPECT_TRUE(stack_.until([this] { return state() == crane_STATE_ESTOP; }, 2s));
  EXPECT_TRUE(client_.answers(2s));
}

TEST_F(DashboardAttack, WithoutTheTokenNoRequestReachesTheSupervisor) {
  stack_.listen(1500ms);
  stack_.forget();
  const std::string guess(token_.size(), '0');
  for (const auto* kind : {R"({"kind":"reset"})", R"({"kind":"arm"})", R"({"kind":"home","axis":"trolley"})",
                           R"({"kind":"move","trolley_m":1})", R"({"kind":"disarm"})"}) {
    EXPECT_EQ(client_.post("/api/request", kind, ""), 403U) << kind;
    EXPECT_EQ(client_.post("/api/request", kind, guess), 403U) << kind;
    EXPECT_EQ(client_.post("/api/request", kind, token_), 409U) << kind;  // without the controls
    for (const auto& [field, value] : {std::pair{"Host", "evil.example"},
                                       {"Origin", "http://evil.example"},
                                       {"Sec-Fetch-Site", "cross-site"}}) {
      http::request<http::string_body> request{http::verb::post, "/api/request", 11, kind};
      request.set(http::field::content_type, "application/json");
      request.set(http::field::authorization, "Bearer " + token_);
      request.set(field, value);
      EXPECT_EQ(client_.ask(std::move(request)), 403U) << kind << field;
    }
  }
  stack_.listen(500ms);
  for (const auto& status : stack_.observer().statuses()) ASSERT_EQ(status.state, crane_STATE_LOCKED);
  EXPECT_EQ(client_.post("/api/operator/take", "{}", token_), 200U);
  const auto at = client_.body().find("\":\"") + 3;
  const auto seat = client_.body().substr(at, client_.body().find('"', at) - at);
  EXPECT_EQ(client_.post("/api/request", R"({"kind":"reset"})", token_, seat), 200U);
  EXPECT_TRUE(stack_.until([this] { return state() == crane_STATE_READY; }, 3s));
}

TEST_F(DashboardAttack, InvalidRunsAndManyDiagnosesDoNotReachTheLoop) {
  arm_and_count_ticks();
  EXPECT_EQ(client_.post("/api/runs/review", R"({"run":"no_recording.mcap"})", ""), 403U);
  EXPECT_EQ(client_.upload("a.csv", "time_s\n", ""), 403U);
  for (const auto* name : {"../token", "/etc/passwd", "no_recording.mcap/../../token"})
    EXPECT_EQ(client_.post("/api/runs/review", R"({"run":")" + std::string{name} + R"("})", token_), 400U)
        << name;
  EXPECT_EQ(client_.post("/api/runs/review", R"({"run":"no_recording.mcap"})", token_), 200U);
  // Requests as much work for the processor as the bounds permit, and more jobs than may wait.
  std::string table = "time_s,trolley_voltage_v,trolley_position_m\n";
  for (int i = 0; i < 2000; ++i)
    table += std::to_string(0.01 * i) + ",1.0," + std::to_string(0.5 + 1e-4 * i) + "\n";
  EXPECT_EQ(client_.upload("a.csv", table, token_), 200U);
  unsigned refused = 0;
  for (int i = 0; i < 15; ++i)
    refused += client_.post("/api/runs/diagnose", R"({"train":["upload:a.csv"],"test":["upload:a.csv"]})",
                            token_) == 503U;
  EXPECT_GT(refused, 0U);
  stack_.listen(5s);
  expect_undisturbed_loop();
  EXPECT_LT(resident_kb(), kLargest_kb);
  EXPECT_EQ(client_.get("/api/jobs"), 200U);
  EXPECT_NE(client_.body().find("no_recording.mcap"), std::string::npos);
}

/// Process ids of the children of a process.
std::vector<pid_t> children_of(pid_t parent) {
  const auto text = std::to_string(parent);
  std::ifstream file{"/proc/" + text + "/task/" + text + "/children"};
  std::vector<pid_t> all;
  for (pid_t pid = 0; file >> pid;) all.push_back(pid);
  return all;
}

std::string program_of(pid_t pid) {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/" + std::to_string(pid) + "/exe", ignored).filename();
}

TEST(DashboardOfAStack, IsRestartedWhenItIsKilledAndTheCraneContinues) {
  const auto port = free_port();
  stack::ChildProcesses children;
  children.start(
      "up", "crane",
      {"up", "--rig", kRig, "--domain", std::to_string(kDomain), "--crane", system_test::crane_name(),
       "--priority", "0", "--dashboard", "--dashboard-port", std::to_string(port)});
  Client client{port};
  ASSERT_TRUE(client.answers(15s));
  const auto answered = std::chrono::steady_clock::now();
  const auto up = *children.pid_of("up");
  const auto dashboard_of = [&] {
    const auto all = children_of(up);
    const auto found = std::ranges::find(all, "crane_dashboard", program_of);
    return found == all.end() ? 0 : *found;
  };
  const auto heard = [&] {
    return client.get("/api/situation") == 200 && client.body().find("\"LOCKED\"") != std::string::npos;
  };
  const auto end = std::chrono::steady_clock::now() + 15s;
  while (!heard() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(100ms);
  ASSERT_TRUE(heard());
  std::this_thread::sleep_until(answered + 1s);  // a dashboard that ends sooner is not restarted
  const auto killed = dashboard_of();
  ASSERT_GT(killed, 0);
  ::kill(killed, SIGKILL);
  EXPECT_TRUE(client.answers(10s));
  EXPECT_NE(dashboard_of(), killed);
  EXPECT_FALSE(children.ended());
}

}  // namespace
}  // namespace crane::hostile
