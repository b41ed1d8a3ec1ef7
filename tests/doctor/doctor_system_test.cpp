/// Injected faults and the findings of the doctor: two hosts (network namespaces with a veth pair), a stopped
/// process, another version, another quality of service, a user without rights, a late timer.
#include <arpa/inet.h>
#include <dds/dds.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <csignal>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <thread>

#include "../interop/two_hosts.hpp"
#include "../recording/temporary_directory.hpp"
#include "../system/program_run.hpp"
#include "../system/running_stack.hpp"
#include "crane/configuration/rig.hpp"
#include "doctor/hardware.hpp"
#include "doctor/network.hpp"
#include "doctor/real_time.hpp"
#include "stack/data_files.hpp"

namespace crane::doctor {
namespace {

using namespace std::chrono_literals;
using hosts::Answer;
using hosts::Running;
using hosts::TwoHosts;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// "code: what: remedy" of each finding.
std::vector<std::string> lines(const Findings& findings) {
  std::vector<std::string> all;
  for (const auto& finding : findings)
    all.push_back(finding.code + ": " + finding.what + ": " + finding.remedy);
  return all;
}

std::vector<std::string> lines(const Answer& answer) {
  Findings findings;
  for (const auto& one : nlohmann::json::parse(answer.output.substr(answer.output.find("[\n"))))
    findings.push_back({Grade::good, one["area"], one["code"], one["what"], one["remedy"]});
  return lines(findings);
}

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

TEST_F(OnTwoHosts, NobodyPublishes) {
  const auto answer = far("--duration 0.5");
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_THAT(lines(answer),
              Contains(HasSubstr("nobody_publishes: nobody publishes for crane 'crane' in domain 0 on "
                                 "127.0.0.1, and no other crane is found: start one with `crane up`")));
}

TEST_F(OnTwoHosts, AnAddressOfAnotherComputerAndAnInterfaceThatIsDown) {
  EXPECT_THAT(lines(far("--interface 10.99.0.1")),
              Contains(HasSubstr("interface_unknown: --interface 10.99.0.1 is no "
                                 "address of this computer: choose one of")));
  hosts_.unplug_far();
  const auto down = far("--interface " + std::string{TwoHosts::kFar});
  EXPECT_EQ(down.exit_code, 1);
  EXPECT_THAT(lines(down), Contains(HasSubstr("interface_down")));
}

TEST_F(OnTwoHosts, BlockedMulticastIsFound) {
  const std::string options = "--duration 0.5 --domain 86 --interface " + std::string{TwoHosts::kFar};
  EXPECT_THAT(lines(far(options)), Contains(HasSubstr("multicast passes")));
  const std::string firewall = "ip netns exec " + hosts_.far() + " iptables -A INPUT -d 239.255.0.1 -j DROP";
  const auto dropping = hosts::run(firewall);
  ASSERT_EQ(dropping.exit_code, 0) << dropping.errors;
  EXPECT_THAT(lines(far(options)), Contains(HasSubstr("multicast_blocked")));
  ASSERT_EQ(
      hosts::run("ip -n " + hosts_.far() + " link set " + hosts_.far_device() + " multicast off").exit_code,
      0);
  EXPECT_THAT(lines(far(options)), Contains(HasSubstr("multicast_refused")));
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

constexpr std::uint32_t kDomain = 88;

TEST(OnOneComputer, AStoppedProcessIsNamedAndAWholeStackIsGood) {
  system_test::RunningStack stack{kDomain, "virginia_tech_tower"};
  const auto ask = [&] {
    const auto ended =
        system_test::run_program(stack::program_directory() / "crane",
                                 {"doctor", "--net", "--json", "--domain", std::to_string(kDomain), "--crane",
                                  system_test::crane_name()});
    return Answer{.exit_code = ended.exit_code, .output = ended.output, .errors = {}};
  };
  const auto healthy = ask();
  EXPECT_THAT(lines(healthy), Contains(HasSubstr("6 processes are heard")));
  EXPECT_EQ(healthy.exit_code, 0) << healthy.output;
  stack.send("anti_swing", SIGSTOP);
  EXPECT_THAT(lines(ask()), Contains(testing::AllOf(HasSubstr("process_stopped: crane_anti_swing"),
                                                    HasSubstr("kill -CONT"))));
  stack.send("anti_swing", SIGCONT);
}

bus::Options options(bus::Vendor vendor, const std::string& participant) {
  bus::Options chosen;
  chosen.vendor = vendor;
  chosen.domain = kDomain;
  chosen.crane = system_test::crane_name();
  chosen.participant = participant;
  return chosen;
}

TEST(OnOneComputer, AProgramOfAnotherVersionIsShownByDoctorAndStatus) {
  system_test::RunningStack stack{kDomain, "virginia_tech_tower"};
  auto other = options(bus::Vendor::cyclone, "old_planner");
  other.messages_version = crane_MESSAGES_VERSION + 1;
  bus::Bus old{other};
  const auto say = [&](const std::vector<std::string>& command) {
    auto arguments = command;
    arguments.insert(arguments.end(),
                     {"--domain", std::to_string(kDomain), "--crane", system_test::crane_name()});
    return system_test::run_program(stack::program_directory() / "crane", arguments).output;
  };
  EXPECT_THAT(say({"status"}),
              HasSubstr("old_planner has messages of version 2, this program has version 1"));
  EXPECT_THAT(say({"status", "--json"}), HasSubstr("\"participant\": \"old_planner\""));
  EXPECT_THAT(say({"doctor", "--net"}), HasSubstr("problem  net  old_planner has messages of version 2"));
}

/// An endpoint of crane/state of another program on Cyclone DDS.
class ForeignEndpoint {
 public:
  /// @param change  sets the quality of service, which is otherwise that of the crane
  ForeignEndpoint(
      const dds_topic_descriptor_t& type, bool writes,
      const std::function<void(dds_qos_t*)>& change = [](dds_qos_t*) {})
      : participant_{dds_create_participant(kDomain, nullptr, nullptr)} {
    const std::string partition = system_test::crane_name(), name{topics::state.description.name};
    const auto topic = dds_create_topic(participant_, &type, name.c_str(), nullptr, nullptr);
    dds_qos_t* qos = dds_create_qos();
    const char* names = partition.c_str();
    dds_qset_partition(qos, 1, &names);
    const auto group = writes ? dds_create_publisher(participant_, qos, nullptr)
                              : dds_create_subscriber(participant_, qos, nullptr);
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(10));
    const dds_data_representation_id_t plain_cdr = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos, 1, &plain_cdr);
    change(qos);
    endpoint_ = writes ? dds_create_writer(group, topic, qos, nullptr)
                       : dds_create_reader(group, topic, qos, nullptr);
    dds_delete_qos(qos);
  }
  ~ForeignEndpoint() { dds_delete(participant_); }
  ForeignEndpoint(const ForeignEndpoint&) = delete;
  ForeignEndpoint& operator=(const ForeignEndpoint&) = delete;
  bool write(const void* sample) const { return dds_write(endpoint_, sample) == DDS_RETCODE_OK; }

 private:
  dds_entity_t participant_, endpoint_ = 0;
};

const dds_topic_descriptor_t& kState = *topics::state.description.descriptor;
const dds_topic_descriptor_t& kDemand = *topics::demand.description.descriptor;

/// The parameter is the DDS vendor of the doctor.
class ForeignProgram : public testing::TestWithParam<bus::Vendor> {
 protected:
  std::vector<std::string> found() {
    bus::Bus doctor{options(GetParam(), "doctor")};
    return lines(judge_mismatches(listen_on(doctor, 3s)));
  }
  /// On the loop-back, as all programs of this project by default; it also opens the domain of Cyclone DDS.
  bus::Bus crane_{options(bus::Vendor::cyclone, "crane_plant")};
};

TEST_P(ForeignProgram, ThatIsAsTheCraneHasNoFinding) {
  const ForeignEndpoint writer{kState, true}, reader{kState, false};
  const auto states = crane_.publisher(topics::state);
  EXPECT_THAT(found(), testing::IsEmpty());
}

TEST_P(ForeignProgram, WithAnotherReliabilityIsNamedWithBothValues) {
  const ForeignEndpoint writer{
      kState, true, [](dds_qos_t* qos) { dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0); }};
  EXPECT_THAT(found(),
              Contains(testing::AllOf(HasSubstr("quality_of_service: a writer of crane/state ("),
                                      HasSubstr(") offers reliability best_effort, the readers of the "
                                                "crane request reliable: its samples do not arrive"))));
}

TEST_P(ForeignProgram, ThatRequestsMoreThanTheCraneOffersIsNamedWithBothValues) {
  const auto states = crane_.publisher(topics::state);
  const ForeignEndpoint reader{kState, false, [](dds_qos_t* qos) {
                                 dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
                                 dds_qset_deadline(qos, DDS_MSECS(20));
                               }};
  const auto all = found();
  EXPECT_THAT(all, Contains(testing::AllOf(
                       HasSubstr("quality_of_service: a reader of crane/state ("),
                       HasSubstr(") requests durability transient_local, the writer of the crane offers "
                                 "volatile: it receives no sample"))));
  EXPECT_THAT(all,
              Contains(HasSubstr("requests deadline 20000 us, the writer of the crane offers infinite")));
}

TEST_P(ForeignProgram, WithAnotherTypeIsNamedWithBothTypes) {
  const ForeignEndpoint writer{kDemand, true};
  EXPECT_THAT(found(), Contains(testing::AllOf(
                           HasSubstr("type_mismatch: a writer of crane/state ("),
                           HasSubstr(") has the type crane::Demand, the crane has crane::CraneState: "
                                     "no sample is exchanged"),
                           HasSubstr("generate the types of that program from crane.idl"))));
}

INSTANTIATE_TEST_SUITE_P(Doctor, ForeignProgram, testing::Values(bus::Vendor::cyclone, bus::Vendor::fastdds),
                         [](const auto& vendor) { return std::string{bus::to_string(vendor.param)}; });

/// The type has the right name and other fields: a program that was built from another IDL file.
TEST(OnOneComputer, SamplesOfAnotherTypeWithTheSameNameAreRejectedAndReported) {
  const bus::Bus crane{options(bus::Vendor::cyclone, "crane_plant")};
  constexpr auto kTypeInformation = static_cast<std::uint32_t>(DDS_TOPIC_XTYPES_METADATA);
  const dds_topic_descriptor_t type{.m_size = kDemand.m_size,
                                    .m_align = kDemand.m_align,
                                    .m_flagset = kDemand.m_flagset & ~kTypeInformation,
                                    .m_nkeys = kDemand.m_nkeys,
                                    .m_typename = kState.m_typename,
                                    .m_keys = kDemand.m_keys,
                                    .m_nops = kDemand.m_nops,
                                    .m_ops = kDemand.m_ops,
                                    .m_meta = kDemand.m_meta,
                                    .type_information = {},
                                    .type_mapping = {},
                                    .restrict_data_representation = 0};
  const ForeignEndpoint writer{type, true};
  std::jthread writing{[&writer](const std::stop_token& stop) {
    const msg::Demand sample{};
    std::mutex mutex;
    std::condition_variable_any stopped;
    std::unique_lock lock{mutex};
    while (!stopped.wait_for(lock, stop, 20ms, [&stop] { return stop.stop_requested(); }))
      EXPECT_TRUE(writer.write(&sample));
  }};
  bus::Bus doctor{options(bus::Vendor::fastdds, "doctor")};
  EXPECT_THAT(lines(judge_mismatches(listen_on(doctor, 3s))),
              Contains(testing::AllOf(HasSubstr("samples_rejected: "),
                                      HasSubstr(" samples of crane/state had a wrong CRC"))));
}

TEST(OnOneComputer, AUserWithoutRightsMayNotScheduleInRealTime) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs root, to give rights up";
  const auto answer =
      hosts::run("prlimit --memlock=65536 setpriv --reuid=65534 --regid=65534 --clear-groups " +
                 (stack::program_directory() / "crane").string() + " doctor --rt --json --duration 0.5");
  EXPECT_EQ(answer.exit_code, 1);
  const auto all = lines(answer);
  EXPECT_THAT(all, Contains(HasSubstr("no_realtime_scheduling")));
  EXPECT_THAT(all, Contains(HasSubstr("memory_not_locked")));
}

/// Occupies the processor several times for longer than the loop tolerates, with a priority above that of the
/// loop.
class Hog {
 public:
  [[nodiscard]] bool granted() const { return granted_; }

 private:
  void run(const std::stop_token& stop) {
    const sched_param parameters{.sched_priority = 95};
    granted_ = ::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
    std::unique_lock lock{mutex_};
    while (!stopped_.wait_for(lock, stop, 90ms, [&stop] { return stop.stop_requested(); })) {
      const auto end = std::chrono::steady_clock::now() + 8ms;
      while (std::chrono::steady_clock::now() < end) {
      }
    }
  }

  std::atomic<bool> granted_{false};
  std::mutex mutex_;
  std::condition_variable_any stopped_;
  std::jthread thread_{[this](const std::stop_token& stop) { run(stop); }};
};

TEST(OnOneComputer, ALateTimerIsAProblemAboveTheToleranceOfTheLoop) {
  cpu_set_t before, one;
  ASSERT_EQ(::sched_getaffinity(0, sizeof before, &before), 0);
  CPU_ZERO(&one);
  CPU_SET(0, &one);
  ASSERT_EQ(::sched_setaffinity(0, sizeof one, &one), 0);  // its threads inherit it
  constexpr double kPeriod_s = 0.01;
  {
    const Hog hog;
    const auto late = measure_lateness(kPeriod_s, 1s, 50);
    if (!hog.granted()) GTEST_SKIP() << "SCHED_FIFO is not permitted";
    EXPECT_GT(late.intolerable, 0U) << late.max_us;
    EXPECT_THAT(lines(judge_lateness(late, kPeriod_s)), Contains(HasSubstr("timer_late")));
  }
  ::sched_setaffinity(0, sizeof before, &before);
}

TEST(OnOneComputer, AMissingBoardIsNamed) {
  const recording::TemporaryDirectory directory;
  std::ofstream{directory / "rig.toml"} << "extends = \"" << stack::find_rig("virginia_tech_tower").string()
                                        << "\"\nname = \"bench\"\nboard = \"comedi\"\n[wiring]\ndevice = "
                                           "\"/dev/comedi_that_is_not_there\"\n";
  const auto found = lines(examine_board(configuration::load_rig((directory / "rig.toml").string())));
  EXPECT_THAT(found, Contains(testing::AllOf(HasSubstr("board_missing: /dev/comedi_that_is_not_there"),
                                             HasSubstr("modprobe"))));
}

}  // namespace
}  // namespace crane::doctor
