/// Many cranes on one computer: a loop in one process behaves like six processes, cranes share a domain,
/// and a full domain is refused with the cause.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <deque>

#include "../recording/temporary_directory.hpp"
#include "crane/bus/ports.hpp"
#include "crane/runtime/writer_binding.hpp"
#include "experiments/realtime_session.hpp"
#include "program_run.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::uint32_t kDomain = 92, kFullDomain = 93;

std::filesystem::path crane_program() { return stack::program_directory() / "crane"; }

class Fleet : public testing::Test {
 protected:
  void TearDown() override { EXPECT_THAT(processes_with(crane_name()), IsEmpty()); }

  [[nodiscard]] std::vector<std::string> up(const std::string& crane, std::vector<std::string> more,
                                            std::uint32_t domain = kDomain) const {
    more.insert(more.begin(), {"up", "--crane", crane, "--domain", std::to_string(domain), "--black-box",
                               (directory_ / crane).string()});
    return more;
  }
  static bus::Bus operator_of(const std::string& crane) {
    return bus::Bus{{.domain = kDomain, .crane = crane, .source = crane_SOURCE_OPERATOR}};
  }

  /// Starts cranes of one domain, moves them one after the other, and ends them together.
  void start_move_and_stop(int cranes);

  recording::TemporaryDirectory directory_;
};

/// Arms the crane, moves its trolley to 0.6 m, and requests a stop.
void move_and_stop(experiments::RealtimeSession& session) {
  session.arm();
  session.move_to({true, false, false}, {0.6, 0, 0}, 20s);
  EXPECT_NEAR(session.state()->trolley_position_m, 0.6, 0.05);
  session.request({.kind = crane_REQUEST_STOP}, "stop");
}

TEST_F(Fleet, ALoopInOneProcessMovesAndEveryComponentKeepsItsIdentity) {
  for (const std::string vendor : {"cyclone", "fastdds"}) {
    ProgramRun run{crane_program(), up(crane_name(), {"--in-process", "--dds", vendor})};
    ASSERT_TRUE(run.wait_for("is up with", 60s)) << vendor << run.errors();
    EXPECT_EQ(processes_with(crane_name()).size(), 3U);  // the command, the loop and the black box
    auto bus = operator_of(crane_name());
    Observer observer{bus};
    experiments::RealtimeSession session{bus, [&] { observer.take(); }};
    move_and_stop(session);
    std::set<std::uint32_t> pids, epochs;
    for (const auto& [name, status] : observer.nodes()) {
      if (status.header.source == crane_SOURCE_OPERATOR) continue;
      pids.insert(status.pid);
      epochs.insert(status.header.epoch);
      EXPECT_EQ(status.phase, crane_PHASE_READY) << name;
      EXPECT_EQ(status.foreign_samples, 0U) << name;
    }
    EXPECT_EQ(pids.size(), 1U) << vendor;
    EXPECT_EQ(epochs.size(), 6U) << vendor;
    run.send(SIGINT);
    EXPECT_EQ(run.wait(20s), 0) << run.errors();
  }
}

/// The protections of the components work between the components of one process, too.
TEST_F(Fleet, ASecondWriterStopsALoopInOneProcess) {
  ProgramRun run{crane_program(), up(crane_name(), {"--in-process"})};
  ASSERT_TRUE(run.wait_for("is up with", 60s)) << run.errors();
  auto bus = operator_of(crane_name());
  experiments::RealtimeSession session{bus, [] {}};
  session.arm();
  bus::Bus stranger{{.domain = kDomain,
                     .crane = crane_name(),
                     .participant = "stranger",
                     .source = crane_SOURCE_FRICTION,
                     .epoch = 4711}};
  auto demands = stranger.publisher(topics::demand);
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  while (session.status()->state == crane_STATE_HOLD && std::chrono::steady_clock::now() < deadline) {
    EXPECT_TRUE(demands.publish({}));
    session.wait(10ms);
  }
  EXPECT_EQ(session.status()->cause, crane_CAUSE_SECOND_WRITER);
  run.send(SIGINT);
  EXPECT_EQ(run.wait(20s), 0) << run.errors();
}

TEST_F(Fleet, ADeathOfTheLoopEndsTheCommandWithItsName) {
  ProgramRun run{crane_program(), up(crane_name(), {"--in-process"})};
  ASSERT_TRUE(run.wait_for("is up with", 60s)) << run.errors();
  for (const pid_t pid : processes_with("crane_loop"))
    for (const pid_t own : processes_with(crane_name()))
      if (pid == own) ::kill(pid, SIGSEGV);
  EXPECT_EQ(run.wait(20s), 1);
  EXPECT_THAT(run.errors(), HasSubstr("loop has ended: signal 11"));
}

void Fleet::start_move_and_stop(int cranes) {
  std::deque<ProgramRun> runs;
  const auto name = [](int i) { return crane_name() + "_" + std::to_string(i); };
  for (int i = 0; i < cranes; ++i) runs.emplace_back(crane_program(), up(name(i), {"--in-process"}));
  for (auto& run : runs) ASSERT_TRUE(run.wait_for("is up with", 60s)) << run.errors();
  for (int i = 0; i < cranes; ++i) {
    auto bus = operator_of(name(i));
    experiments::RealtimeSession session{bus, [] {}};
    move_and_stop(session);
  }
  for (const auto& run : runs) run.send(SIGINT);
  for (auto& run : runs) EXPECT_EQ(run.wait(20s), 0) << run.errors();
}

TEST_F(Fleet, FourCranesInOneDomainMoveAndStop) { start_move_and_stop(4); }

/// Sixteen cranes occupy two thirds of two processors, and all of them while they start.
class LongFleet : public Fleet {};

TEST_F(LongFleet, SixteenCranesInOneDomainMoveAndStop) { start_move_and_stop(16); }

/// Sockets on the discovery ports of a domain, as participants of other programs hold them.
class TakenPorts {
 public:
  explicit TakenPorts(std::uint32_t domain) {
    for (std::uint32_t number = 0; number < bus::most_participants(); ++number) {
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_addr.s_addr = htonl(INADDR_ANY);
      address.sin_port = htons(static_cast<std::uint16_t>(bus::unicast_port(domain, number)));
      sockets_.push_back(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
      taken_ += ::bind(sockets_.back(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    }
  }
  ~TakenPorts() {
    for (const int socket : sockets_) ::close(socket);
  }
  TakenPorts(const TakenPorts&) = delete;
  TakenPorts& operator=(const TakenPorts&) = delete;
  void release_one() {
    ::close(sockets_.back());
    sockets_.pop_back();
  }
  [[nodiscard]] int taken() const { return taken_; }

 private:
  std::vector<int> sockets_;
  int taken_ = 0;
};

TEST_F(Fleet, AFullDomainIsRefusedWithItsLimitAndTheRemedyByBothVendors) {
  TakenPorts ports{kFullDomain};
  ASSERT_EQ(ports.taken(), 120);
  for (const std::string vendor : {"cyclone", "fastdds"}) {
    const auto ended = run_program(crane_program(), up(crane_name(), {"--dds", vendor}, kFullDomain));
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_THAT(ended.errors, AllOf(HasSubstr("domain 93 has no free participant number on 127.0.0.1"),
                                    HasSubstr("120 programs per host (30660 to 30899"),
                                    HasSubstr("--in-process or another --domain")));
  }
  ports.release_one();
  const auto join = [](bus::Vendor vendor) {
    return bus::Bus{{.vendor = vendor, .domain = kFullDomain, .crane = crane_name()}};
  };
  EXPECT_NO_THROW(join(bus::Vendor::cyclone));
  EXPECT_NO_THROW(join(bus::Vendor::fastdds));
}

/// Its first samples would stop the crane.
TEST_F(Fleet, ALoopOfTheOtherVendorIsRefusedBesideAnArmedCraneWhichContinues) {
  ProgramRun first{crane_program(), up(crane_name(), {"--dds", "cyclone"})};
  ASSERT_TRUE(first.wait_for("is up with", 60s)) << first.errors();
  auto bus = operator_of(crane_name());
  Observer observer{bus};
  experiments::RealtimeSession session{bus, [&] { observer.take(); }};
  session.arm();
  ProgramRun second{crane_program(), up(crane_name(), {"--in-process", "--dds", "fastdds"})};
  EXPECT_EQ(second.wait(60s), 1);
  EXPECT_THAT(second.errors(), HasSubstr("another process already writes crane/"));
  EXPECT_EQ(second.output().find("is up with"), std::string::npos);
  observer.take();
  for (const auto& status : observer.statuses())
    EXPECT_TRUE(status.state != crane_STATE_STOP_C0 && status.cause != crane_CAUSE_SECOND_WRITER);
  EXPECT_EQ(observer.statuses().back().state, crane_STATE_HOLD);
  first.send(SIGINT);
  EXPECT_EQ(first.wait(20s), 0);
}

TEST_F(Fleet, ARealCraneIsRefusedInOneProcessBeforeAnythingStarts) {
  const auto ended = run_program(
      crane_program(),
      up(crane_name(), {"--in-process", "--plant", "hardware", "--rig", "emulated_servo_to_go", "--clock",
                        "lockstep", "--dds-for", "tracking=fastdds", "--secure", "keys"}));
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors,
              AllOf(HasSubstr("cannot be combined with --plant hardware: an error in one "
                              "component would end or corrupt supervisor and bridge"),
                    HasSubstr("cannot be combined with --clock lockstep"),
                    HasSubstr("cannot be combined with --secure: a process has the rights of one"),
                    HasSubstr("cannot be combined with --dds-for tracking=fastdds")));
}

}  // namespace
}  // namespace crane::system_test
