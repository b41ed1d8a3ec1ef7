/// Findings of the doctor for given observations. doctor_system_test injects the faults themselves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../recording/temporary_directory.hpp"
#include "crane/runtime/node.hpp"
#include "doctor/network.hpp"
#include "doctor/real_time.hpp"

namespace crane::doctor {
namespace {

using testing::HasSubstr;

Observed whole_loop() {
  Observed observed;
  observed.states = 100;
  for (const auto source : {crane_SOURCE_PLANT, crane_SOURCE_PLANNER, crane_SOURCE_TRACKING,
                            crane_SOURCE_ANTI_SWING, crane_SOURCE_FRICTION, crane_SOURCE_SUPERVISOR}) {
    msg::NodeStatus node{};
    node.node = source;
    node.phase = crane_PHASE_READY;
    node.ticks = 1000;
    runtime::assign(node.name, "process " + std::to_string(source));
    observed.nodes[source] = node;
  }
  return observed;
}

const ExpectedCrane kExpected{"crane", 0, {"127.0.0.1"}, false};

LocalProcess running(const std::vector<std::string>& options) {
  std::vector<std::string> arguments{"crane_plant"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return process_from(arguments);
}

TEST(Doctor, FindsNothingInAWholeLoop) {
  const auto observed = whole_loop();
  EXPECT_TRUE(judge_silence(kExpected, observed, {running({"--crane", "other"})}, {}).empty());
  const auto found = judge_processes_on_bus(observed);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].grade, Grade::good);
  EXPECT_TRUE(judge_mismatches(observed).empty());
}

TEST(Doctor, NamesTheMissingAndTheStartingProcess) {
  auto observed = whole_loop();
  observed.nodes.erase(crane_SOURCE_ANTI_SWING);
  observed.nodes[crane_SOURCE_TRACKING].phase = crane_PHASE_STARTING;
  const auto found = judge_processes_on_bus(observed);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_THAT(found[0].what, HasSubstr("anti_swing is not heard"));
  EXPECT_EQ(found[1].code, "process_starting");
}

TEST(Doctor, NamesAClockThatDiffers) {
  auto observed = whole_loop();
  observed.clock_offset_s["process " + std::to_string(crane_SOURCE_PLANT)] = -40;
  const auto found = judge_processes_on_bus(observed);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].grade, Grade::advice);
  EXPECT_THAT(found[0].what, HasSubstr("40 s behind"));
  EXPECT_EQ(found[1].grade, Grade::good);
}

TEST(Doctor, NamesTheOptionThatWouldFindTheCrane) {
  const auto remedy = [](const std::vector<std::string>& options) {
    const auto found = judge_silence(kExpected, {}, {running(options)}, {});
    return found.size() == 1 ? found[0].code + ": " + found[0].remedy : "";
  };
  EXPECT_EQ(remedy({"--crane", "north"}), "wrong_crane: add --crane north");
  EXPECT_EQ(remedy({"--domain", "4"}), "wrong_domain: add --domain 4");
  EXPECT_EQ(remedy({"--interface", "10.0.0.5"}), "wrong_interface: add --interface 10.0.0.5");
  EXPECT_EQ(remedy({"--secure", "keys"}), "wrong_keys: add --secure DIR");
  const auto announced = judge_silence(kExpected, {}, {}, {{"10.0.0.9", 3, {1, "north", "crane_plant"}}});
  ASSERT_EQ(announced.size(), 1U);
  EXPECT_THAT(announced[0].what, HasSubstr("announces itself from 10.0.0.9 in domain 3"));
  EXPECT_EQ(announced[0].remedy, "add --crane north --domain 3");
  EXPECT_EQ(judge_silence(kExpected, {}, {}, {})[0].code, "nobody_publishes");
}

bus::FoundEndpoint endpoint(bool writes, const topics::Description& topic = topics::state.description) {
  return {.writes = writes,
          .topic = std::string{topic.name},
          .type = std::string{topic.type},
          .partitions = {"crane"},
          .policies = bus::reader_policies(topic),
          .origin = "program"};
}

TEST(Doctor, FindsNothingInEndpointsOfTheCraneAndInOtherTopics) {
  std::vector<bus::FoundEndpoint> all;
  for (const auto& topic : topics::kAll)
    for (const bool writes : {true, false}) all.push_back(endpoint(writes, topic));
  auto other = endpoint(true);
  other.topic = "lamp";
  other.policies.reliable = false;
  all.push_back(other);
  EXPECT_TRUE(judge_endpoints(all).empty());
}

TEST(Doctor, NamesEachPolicyThatAWriterLacksOnce) {
  auto writer = endpoint(true, topics::node.description);
  writer.policies = {.exclusive = true, .representations = {2, 0}};
  const auto found = judge_endpoints({writer, writer, endpoint(false, topics::node.description)});
  ASSERT_EQ(found.size(), 4U);
  constexpr std::array kDifferences{"reliability best_effort, the readers of the crane request reliable",
                                    "durability volatile, the readers of the crane request transient_local",
                                    "ownership exclusive, the readers of the crane request shared",
                                    "data representation XCDR2, the readers of the crane request XCDR1"};
  for (std::size_t i = 0; i < kDifferences.size(); ++i)
    EXPECT_EQ(found[i].what, "a writer of crane/node (program) offers " + std::string{kDifferences.at(i)} +
                                 ": its samples do not arrive");
}

TEST(Doctor, ComparesAReaderWithTheWritersOfTheCrane) {
  auto reader = endpoint(false);
  reader.policies.liveliness = 2;
  reader.policies.lease = std::chrono::milliseconds{100};
  EXPECT_TRUE(judge_endpoints({reader}).empty()) << "without a writer, the reader lacks nothing";
  const auto found = judge_endpoints({reader, endpoint(true)});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].what,
            "a reader of crane/state (program) requests liveliness manual_by_topic, the writer of the crane "
            "offers automatic: it receives no sample");
  EXPECT_THAT(found[1].what, HasSubstr("requests liveliness lease 100000 us"));
}

TEST(Doctor, AssignsAnEndpointToACraneByNameAndPattern) {
  auto one = endpoint(true);
  for (const std::string pattern : {"crane", "cr*", "*", "cr?ne"}) {
    one.partitions = {"other", pattern};
    EXPECT_TRUE(bus::belongs_to(one, "crane")) << pattern;
  }
  one.partitions = {"north"};
  EXPECT_FALSE(bus::belongs_to(one, "crane"));
  one.partitions = {};
  EXPECT_FALSE(bus::belongs_to(one, "crane"));
}

TEST(Doctor, CountsTheParticipantsThatUnicastFinds) {
  const std::vector<LocalProcess> few(119, running({})), many(120, running({}));
  EXPECT_TRUE(judge_number_of_participants(few, 0).empty());
  EXPECT_EQ(judge_number_of_participants(many, 0)[0].code, "too_many_participants");
  EXPECT_TRUE(judge_number_of_participants(many, 1).empty());
}

TEST(Doctor, ReadsReceiveBuffersAndLossesOfTheKernel) {
  const recording::TemporaryDirectory proc;
  std::filesystem::create_directories(proc / "sys/net/core");
  std::filesystem::create_directories(proc / "net");
  std::ofstream{proc / "sys/net/core/rmem_max"} << "212992\n";
  std::ofstream{proc / "net/snmp"} << "Ip: Forwarding\nIp: 1\nUdp: InDatagrams NoPorts InErrors OutDatagrams "
                                      "RcvbufErrors\nUdp: 5000 1 2 3 42\n";
  const auto buffers = read_buffers(proc / "");
  EXPECT_EQ(buffers.largest_bytes, 212992);
  EXPECT_EQ(buffers.lost, 42);
  EXPECT_EQ(buffers.received, 5000);
  const auto found = judge_buffers(buffers);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_THAT(found[0].remedy, HasSubstr("net.core.rmem_max=1048576"));
  EXPECT_THAT(found[1].what, HasSubstr("42 datagrams"));
  EXPECT_EQ(judge_buffers({4 << 20, 0, 1})[0].grade, Grade::good);
}

TEST(Doctor, ComparesTheTimerWithHalfAPeriod) {
  constexpr double kPeriod_s = 0.01;
  EXPECT_EQ(tolerable_ns(kPeriod_s), 5'000'000);
  EXPECT_EQ(judge_lateness({true, 300, 80, 200, 0}, kPeriod_s)[0].grade, Grade::good);
  EXPECT_EQ(judge_lateness({true, 300, 80, 4000, 0}, kPeriod_s)[0].grade, Grade::advice);
  const auto late = judge_lateness({false, 300, 80, 6000, 1}, kPeriod_s);
  EXPECT_EQ(late[0].grade, Grade::problem);
  EXPECT_THAT(late[0].what, HasSubstr("at most 6000 us"));
  EXPECT_THAT(late[0].remedy, HasSubstr("SCHED_FIFO"));
}

TEST(Doctor, PrintsOneLineForEachFinding) {
  EXPECT_EQ(line_of({Grade::problem, "net", "x", "what", "remedy"}), "problem  net  what: remedy");
  EXPECT_EQ(line_of({Grade::good, "rt", "x", "what", ""}), "good     rt  what");
}

}  // namespace
}  // namespace crane::doctor
