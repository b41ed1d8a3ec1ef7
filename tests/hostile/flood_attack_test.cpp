/// A foreign program without keys fills memory or time of the loop, or disturbs topics that no process of the
/// loop binds to one writer. Permitted: the crane stops. Forbidden: motion, a process that hangs, memory
/// without bound.
#include <sys/resource.h>

#include <csignal>
#include <tuple>

#include "../recording/temporary_directory.hpp"
#include "armed_crane.hpp"
#include "crane/runtime/memory_limit.hpp"

namespace crane::hostile {
namespace {

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
        for (int i = 0; i < 500; ++i, ++status.node) (void)nodes.dispose(status);
        largest_kb = std::max(largest_kb, resident_kb(supervisor));
        ended = stack_.children().ended();
        return ended.has_value();
      },
      60s);
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

/// Every process may write crane/node. A status there names a supervisor that is in use and has the smallest
/// start-up number.
TEST_P(StrangerBesideAnArmedCrane, CannotPreventTheStartOfASupervisorByForgedStatuses) {
  bus::Bus bus{runtime::bus_options(options(GetParam()), "stranger", crane_SOURCE_SUPERVISOR, 1)};
  auto nodes = bus.publisher(topics::node);
  const auto forge = [&] {
    msg::NodeStatus status{};
    status.node = crane_SOURCE_SUPERVISOR;
    status.phase = crane_PHASE_READY;
    status.ticks = 1'000'000;
    (void)nodes.publish(status);
  };
  attack_for(1s, forge);
  stack_.send("supervisor", SIGKILL);
  attack_for(500ms, forge);
  stack_.start_again("supervisor");
  stack_.forget();
  const auto locked = [&] {
    forge();
    const auto& statuses = stack_.observer().statuses();
    return !statuses.empty() && statuses.back().state == crane_STATE_LOCKED;
  };
  ASSERT_TRUE(stack_.until(locked, 8s));
  attack_for(2s, forge);
  EXPECT_TRUE(pid_of("supervisor"));
  EXPECT_NO_THROW(stack_.session().arm());
}

INSTANTIATE_TEST_SUITE_P(Vendors, StrangerBesideAnArmedCrane, testing::Values("cyclone", "fastdds"),
                         [](const auto& vendor) { return vendor.param; });

}  // namespace
}  // namespace crane::hostile
