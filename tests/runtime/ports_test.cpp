// A component gets the endpoints that its ComponentSpec declares, and no others.
#include "crane/runtime/ports.hpp"

#include <gtest/gtest.h>

#include "crane/runtime/in_process.hpp"

namespace crane::runtime {
namespace {

class PortsTest : public testing::Test {
 protected:
  static ComponentSpec tracking() {
    return {.name = "tracking",
            .program = "crane_tracking",
            .summary = "",
            .source = crane_SOURCE_TRACKING,
            .runs_controller = true,
            .reads = {{&topics::state.description, "a state"},
                      {&topics::anti_swing.description, "a correction",
                       [](const control::Controller& controller) { return controller.corrects_reference; }}},
            .writes = {{&topics::tracking.description, "volts"}},
            .make = nullptr};
  }
  Ports ports(const ComponentSpec& spec, const char* controller = "delayed_1") {
    return {bus_, spec, *control::find_controller(controller), design_, Clock::realtime};
  }
  control::Design design_;
  bus::Bus bus_{memory_options(bus::make_memory_network(), "tracking", crane_SOURCE_TRACKING)};
};

TEST_F(PortsTest, RefusesATopicThatTheSpecificationDoesNotName) {
  const auto spec = tracking();
  auto ports = this->ports(spec);
  EXPECT_THROW((void)ports.loop_input(topics::command), std::logic_error);
  EXPECT_THROW((void)ports.output(topics::command), std::logic_error);
  EXPECT_NO_THROW((void)ports.loop_input(topics::state));
}

TEST_F(PortsTest, RefusesAWriterThatTheTopicDoesNotAllow) {
  auto spec = tracking();
  spec.writes.push_back({&topics::command.description, "what is not its business"});
  auto ports = this->ports(spec);
  EXPECT_THROW((void)ports.output(topics::command), std::logic_error);
}

TEST_F(PortsTest, ReportsDeclaredTopicsThatTheComponentDoesNotUse) {
  const auto spec = tracking();
  auto ports = this->ports(spec);
  (void)ports.loop_input(topics::state);
  EXPECT_THROW(ports.require_complete(), std::logic_error);
  (void)ports.output(topics::tracking);
  EXPECT_NO_THROW(ports.require_complete());
}

TEST_F(PortsTest, AnInputMayBeNeededBySomeControllersOnly) {
  const auto spec = tracking();
  auto without = ports(spec, "delayed_1");
  EXPECT_THROW((void)without.loop_input(topics::anti_swing), std::logic_error);
  auto with = ports(spec, "delayed_2");
  EXPECT_NO_THROW((void)with.loop_input(topics::anti_swing));
}

TEST_F(PortsTest, AnOutputMayBeWrittenWithSomeRigFilesOnly) {
  auto spec = tracking();
  spec.writes.push_back({&topics::anti_swing.description, "with the observer", true,
                         [](const control::Design& design) { return design.swing_observer; }});
  spec.source = crane_SOURCE_ANTI_SWING;
  design_.swing_observer = false;
  auto without = ports(spec);
  EXPECT_THROW((void)without.output(topics::anti_swing), std::logic_error);
  design_.swing_observer = true;
  auto with = ports(spec);
  EXPECT_NO_THROW((void)with.output(topics::anti_swing));
}

TEST_F(PortsTest, AreConnectedWhenInputsHaveWritersAndOutputsReaders) {
  const auto spec = tracking();
  auto ports = this->ports(spec);
  const auto input = ports.loop_input(topics::state);
  const auto output = ports.output(topics::tracking);
  EXPECT_FALSE(ports.connected());
  const auto writer = bus_.publisher(topics::state);
  EXPECT_FALSE(ports.connected());
  const auto reader = bus_.subscriber(topics::tracking);
  EXPECT_TRUE(ports.connected());
}

}  // namespace
}  // namespace crane::runtime
