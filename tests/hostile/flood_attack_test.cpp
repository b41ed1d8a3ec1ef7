/// A foreign program without keys fills memory or time of the loop, or disturbs topics that no process of the
/// loop binds to one writer. Permitted: the crane stops. Forbidden: motion, a process that hangs, memory
/// without bound.
#include <dds/dds.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <iostream>
#include <limits>
#include <tuple>

#include "../recording/temporary_directory.hpp"
#include "../system/running_stack.hpp"
#include "crane/bus/seal.hpp"
#include "crane/runtime/memory_limit.hpp"
#include "wire.hpp"

namespace crane::hostile {
namespace {

using namespace std::chrono_literals;
using system_test::RunningStack;

constexpr std::uint32_t kDomain = 84;
constexpr double kStill_m = 0.01;  ///< motion of an axis in HOLD by swing and control
constexpr long kGrowth_kb = 8 * 1024;
constexpr const char* kLoop[] = {"plant",      "trajectory_planner",    "tracking",
                                 "anti_swing", "friction_compensation", "supervisor"};

class ArmedCrane : public testing::Test {
 protected:
  ArmedCrane() {
    stack_.session().arm();
    stack_.forget();
    for (const char* process : kLoop) before_kb_[process] = resident_kb(pid_of(process).value());
  }
  [[nodiscard]] std::optional<pid_t> pid_of(const std::string& process) const {
    return stack_.children().pid_of(process);
  }
  [[nodiscard]] runtime::BusOptions options(const std::string& vendor = "cyclone") const {
    auto options = stack_.bus_options();
    options.vendor = vendor;
    return options;
  }
  void attack_for(std::chrono::milliseconds duration, const std::function<void()>& attack) {
    (void)stack_.until(
        [&] {
          attack();
          return false;
        },
        duration);
  }
  void expect_no_motion() const {
    const auto& states = stack_.observer().states();
    ASSERT_GT(states.size(), 50U);
    for (const auto& state : states)
      ASSERT_NEAR(state.trolley_position_m, states.front().trolley_position_m, kStill_m);
  }
  void expect_hold() {
    stack_.listen(200ms);
    const auto& statuses = stack_.observer().statuses();
    EXPECT_EQ(statuses.back().state, crane_STATE_HOLD) << experiments::in_words(statuses.back());
    expect_no_motion();
    EXPECT_FALSE(stack_.children().ended());
  }
  void expect_little_growth() const {
    for (const auto& [process, kb] : before_kb_)
      EXPECT_LE(resident_kb(pid_of(process).value()) - kb, kGrowth_kb) << process;
  }

  mutable RunningStack stack_{kDomain, "virginia_tech_tower"};
  std::map<std::string, long> before_kb_;
};

/// Every disposed instance occupies memory of each reader as long as its writer exists.
TEST_F(ArmedCrane, IsStoppedByTheEndOfAProcessWhoseMemoryAStrangerFills) {
  for (const char* process : kLoop) {
    rlimit limit{};
    ASSERT_EQ(::prlimit(pid_of(process).value(), RLIMIT_DATA, nullptr, &limit), 0);
    EXPECT_LE(limit.rlim_cur, 2 * runtime::kMostGrowth_bytes) << process;
  }
  const pid_t supervisor = pid_of("supervisor").value();
  const auto most_kb = before_kb_["supervisor"] + (24L << 10U);
  const rlimit lower{.rlim_cur = static_cast<rlim_t>(most_kb) << 10U, .rlim_max = RLIM_INFINITY};
  ASSERT_EQ(::prlimit(supervisor, RLIMIT_DATA, &lower, nullptr), 0);  // saves the time to fill 512 MB
  bus::Bus bus{runtime::bus_options(options(), "stranger", crane_SOURCE_OPERATOR, 3)};
  auto nodes = bus.publisher(topics::node);
  msg::NodeStatus status{};
  long largest_kb = 0;
  std::optional<stack::Ended> ended;
  (void)stack_.until(
      [&] {
        for (int i = 0; i < 200; ++i, ++status.node) (void)nodes.dispose(status);
        largest_kb = std::max(largest_kb, resident_kb(supervisor));
        ended = stack_.children().ended();
        return ended.has_value();
      },
      30s);
  ASSERT_TRUE(ended);
  std::cout << "supervisor: " << ended->how << " after " << status.node << " instances, at most "
            << largest_kb - before_kb_["supervisor"] << " kB\n";
  EXPECT_EQ(ended->name, "supervisor");
  stack_.listen(200ms);
  expect_no_motion();
  const auto& state = stack_.observer().states().back();
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(state.brake_closed[i] && state.applied_v[i] == 0);
}

/// The parameter is the DDS vendor of the attacker.
class StrangerBesideAnArmedCrane : public ArmedCrane, public testing::WithParamInterface<std::string> {};

TEST_P(StrangerBesideAnArmedCrane, CannotStopItByTheEndOfInstances) {
  const auto topics = std::tuple{topics::request, topics::reply, topics::jog,       topics::node,
                                 topics::event,   topics::twin,  topics::adaptation};
  bus::Bus bus{runtime::bus_options(options(GetParam()), "stranger", crane_SOURCE_OPERATOR, 3)};
  const auto dispose_all = [&](const auto&... topic) {
    const auto dispose = [&]<class T>(const topics::Topic<T>& one) {
      auto writer = bus.publisher(one);
      attack_for(150ms, [&] {
        T sample{};
        sample.header.tick = stack_.session().state()->header.tick;
        (void)writer.publish(sample);
        (void)writer.dispose(sample);
      });
    };
    (dispose(topic), ...);
  };
  std::apply(dispose_all, topics);
  expect_hold();
  EXPECT_NO_THROW(stack_.session().request({.kind = crane_REQUEST_ESTOP}, "estop"));
}

/// No process of the loop reads these topics.
TEST_P(StrangerBesideAnArmedCrane, CannotDisturbItByForgedAdaptationTwinRepliesAndEvents) {
  bus::Bus bus{runtime::bus_options(options(GetParam()), "stranger", crane_SOURCE_FRICTION, 3)};
  auto adaptations = bus.publisher(topics::adaptation);
  auto twins = bus.publisher(topics::twin);
  auto replies = bus.publisher(topics::reply);
  auto events = bus.publisher(topics::event);
  std::uint64_t sent = 0;
  attack_for(2s, [&] {
    for (int i = 0; i < 20; ++i, ++sent) {
      msg::Adaptation adaptation{};
      adaptation.header.tick = stack_.session().state()->header.tick;
      adaptation.load_mass_kg = 1e300;
      adaptation.axis[0].positive.used_coulomb_v = 1e300;
      msg::Twin twin{};
      twin.header = adaptation.header;
      msg::Reply reply{};
      reply.request_id = sent;
      reply.accepted = true;
      msg::Event event{};
      event.severity = crane_SEVERITY_ERROR;
      (void)(adaptations.publish(adaptation) && twins.publish(twin) && replies.publish(reply) &&
             events.publish(event));
    }
  });
  std::cout << sent << " samples of each topic\n";
  expect_hold();
  expect_little_growth();
}

/// A stopped reader acknowledges nothing until its lease of 10 s ends.
TEST_P(StrangerBesideAnArmedCrane, CannotStopItByAReaderThatHangs) {
  const recording::TemporaryDirectory directory;
  auto arguments = runtime::arguments(options(GetParam()));
  arguments.insert(arguments.begin(), {"record", (directory / "run.mcap").string()});
  stack_.children().start("recorder", "crane", arguments);
  ASSERT_TRUE(stack_.until([this] { return stack_.observer().nodes().contains("recorder"); }, 10s));
  stack_.send("recorder", SIGSTOP);
  stack_.forget();
  stack_.listen(11s);
  stack_.send("recorder", SIGKILL);
  const auto& statuses = stack_.observer().statuses();
  EXPECT_EQ(statuses.back().state, crane_STATE_HOLD) << experiments::in_words(statuses.back());
  expect_no_motion();
  expect_little_growth();
}

INSTANTIATE_TEST_SUITE_P(Vendors, StrangerBesideAnArmedCrane, testing::Values("cyclone", "fastdds"),
                         [](const auto& vendor) { return vendor.param; });

/// A writer with the name of one topic and the type of another.
class OtherType {
 public:
  /// @param type_name  nullptr: the name of the type of `content`
  OtherType(const topics::Description& topic, const topics::Description& content, const char* type_name)
      : descriptor_{type_name == nullptr ? *content.descriptor : renamed(*content.descriptor, type_name)},
        participant_{dds_create_participant(kDomain, nullptr, nullptr)} {
    dds_qos_t* qos = dds_create_qos();
    const std::string crane = system_test::crane_name();
    const char* partition = crane.c_str();
    dds_qset_partition(qos, 1, &partition);
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(10));
    const dds_data_representation_id_t plain_cdr = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos, 1, &plain_cdr);
    const auto entity =
        dds_create_topic(participant_, &descriptor_, std::string{topic.name}.c_str(), nullptr, nullptr);
    const auto publisher = dds_create_publisher(participant_, qos, nullptr);
    writer_ = dds_create_writer(publisher, entity, qos, nullptr);
    dds_delete_qos(qos);
  }
  ~OtherType() { dds_delete(participant_); }
  OtherType(const OtherType&) = delete;
  OtherType& operator=(const OtherType&) = delete;
  /// @param time_ns  source time stamp
  bool write(const void* sample, std::int64_t time_ns) {
    return dds_write_ts(writer_, sample, time_ns) == DDS_RETCODE_OK;
  }
  [[nodiscard]] bool exists() const { return writer_ > 0; }
  [[nodiscard]] int matched() const {
    dds_publication_matched_status_t status{};
    dds_get_publication_matched_status(writer_, &status);
    return static_cast<int>(status.current_count);
  }

 private:
  /// Without the type information, which would show the disguise at discovery.
  static dds_topic_descriptor_t renamed(const dds_topic_descriptor_t& type, const char* name) {
    return {.m_size = type.m_size,
            .m_align = type.m_align,
            .m_flagset = type.m_flagset & ~static_cast<std::uint32_t>(DDS_TOPIC_XTYPES_METADATA),
            .m_nkeys = type.m_nkeys,
            .m_typename = name,
            .m_keys = type.m_keys,
            .m_nops = type.m_nops,
            .m_ops = type.m_ops,
            .m_meta = type.m_meta,
            .type_information = {},
            .type_mapping = {},
            .restrict_data_representation = type.restrict_data_representation};
  }

  dds_topic_descriptor_t descriptor_;
  dds_entity_t participant_, writer_ = 0;
};

TEST_F(ArmedCrane, IsNotSteeredByOtherTypesUnderTheNamesOfItsTopics) {
  msg::Event event{};
  std::ranges::fill(event.what, '5');
  event.what[sizeof event.what - 1] = 0;
  bus::seal(topics::event.description, &event, crane_SOURCE_OPERATOR, 3);
  for (const auto* topic :
       {&topics::request.description, &topics::jog.description, &topics::node.description}) {
    OtherType other{*topic, topics::event.description, nullptr};
    OtherType disguised{*topic, topics::event.description, topic->descriptor->m_typename};
    ASSERT_TRUE(other.exists() && disguised.exists());
    attack_for(300ms, [&] {
      (void)other.write(&event, dds_time());
      (void)disguised.write(&event, dds_time());
    });
    std::cout << topic->name << ": " << other.matched() << " and " << disguised.matched() << " readers\n";
  }
  expect_hold();
  for (const auto* topic : {&topics::command.description, &topics::demand.description}) {
    OtherType disguised{*topic, topics::event.description, topic->descriptor->m_typename};
    attack_for(700ms, [&] { (void)disguised.write(&event, dds_time()); });
    std::cout << topic->name << ": " << disguised.matched() << " readers, "
              << experiments::in_words(stack_.observer().statuses().back()) << '\n';
  }
  expect_no_motion();
}

/// Samples are delivered in the order of arrival. A time stamp of the year 2262 does not displace later
/// stops.
TEST_F(ArmedCrane, ObeysAStopAfterRequestsFromTheFuture) {
  msg::Request request{};
  request.id = 1;
  request.kind = crane_REQUEST_MOVE;
  request.selected[0] = true;
  request.target[0] = 99;  // refused
  bus::seal(topics::request.description, &request, crane_SOURCE_OPERATOR, 3);
  OtherType future{topics::request.description, topics::request.description, nullptr};
  attack_for(500ms,
             [&] { EXPECT_TRUE(future.write(&request, std::numeric_limits<std::int64_t>::max() - 1)); });
  EXPECT_GT(future.matched(), 0);
  expect_hold();
  EXPECT_NO_THROW(stack_.session().request({.kind = crane_REQUEST_ESTOP}, "estop"));
}

}  // namespace
}  // namespace crane::hostile
