/// Another program writes texts that control a terminal: names of processes, events, remedies, replies, its
/// own name on the bus. Each tool of the operator must show only visible characters and no additional lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <list>
#include <nlohmann/json.hpp>

#include "../system/program_run.hpp"
#include "../system/running_stack.hpp"
#include "crane/fields/printable.hpp"
#include "crane/runtime/node.hpp"
#include "stack/data_files.hpp"

namespace crane::hostile {
namespace {

constexpr std::uint32_t kDomain = 71;
/// Clears the screen, sets the title, shows a false line, reverses the direction; a byte that is no UTF-8.
constexpr const char* kText =
    "\x1b[2J\x1b]0;x\x07\r\nsupervisor  HOLD\n\xC2\x9B"
    "31m\xE2\x80\xAE\xFF";

/// A program that pretends to be the planner of a crane.
class Writer {
 public:
  explicit Writer(const std::string& vendor, std::uint32_t messages_version = crane_MESSAGES_VERSION)
      : bus_{options(vendor, messages_version)},
        nodes_{bus_.publisher(topics::node)},
        events_{bus_.publisher(topics::event)},
        statuses_{bus_.publisher(topics::supervisor)} {
    msg::NodeStatus node{};
    node.node = crane_SOURCE_PLANNER;
    runtime::assign(node.name, kText);
    for (auto* field : {&node.vendor, &node.version}) runtime::assign(*field, kText);
    runtime::assign(node.controller, kText);
    (void)nodes_.publish(node);
    msg::Event event{};
    event.severity = crane_SEVERITY_ERROR;
    runtime::assign(event.node, kText);
    runtime::assign(event.code, kText);
    runtime::assign(event.what, kText);
    runtime::assign(event.remedy, kText);
    (void)events_.publish(event);
  }
  /// Starts all tools at the same time, and writes a status until each has ended.
  [[nodiscard]] std::vector<system_test::Ended> watched_by(
      const std::vector<std::vector<std::string>>& tools) {
    std::list<system_test::ProgramRun> runs;
    for (auto arguments : tools) {
      arguments.insert(arguments.end(),
                       {"--domain", std::to_string(kDomain), "--crane", system_test::crane_name()});
      runs.emplace_back(stack::program_directory() / "crane", arguments);
    }
    std::vector<system_test::Ended> ended;
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds{30};
    for (auto& run : runs) {
      std::optional<int> code;
      while (!code && std::chrono::steady_clock::now() < give_up) {
        msg::SupervisorStatus status{};
        status.header.tick = ++tick_;
        status.state = crane_STATE_RUN;
        runtime::assign(status.move.client, kText);
        (void)statuses_.publish(status);
        code = run.wait(std::chrono::milliseconds{10});
      }
      ended.push_back({code.value_or(-1), run.output(), run.errors()});
    }
    return ended;
  }

 private:
  static bus::Options options(const std::string& vendor, std::uint32_t messages_version) {
    runtime::BusOptions options;
    options.vendor = vendor;
    options.domain = kDomain;
    options.crane = system_test::crane_name();
    auto made = runtime::bus_options(options, kText, crane_SOURCE_PLANNER, 7);
    made.messages_version = messages_version;
    return made;
  }
  bus::Bus bus_;
  bus::Publisher<msg::NodeStatus> nodes_;
  bus::Publisher<msg::Event> events_;
  bus::Publisher<msg::SupervisorStatus> statuses_;
  std::uint64_t tick_ = 0;
};

/// Each line is visible text, and none of them is the line that the attacker wrote.
void expect_harmless(const std::string& output) {
  std::istringstream lines{output};
  for (std::string line; std::getline(lines, line);) {
    auto printable = line;
    EXPECT_FALSE(fields::make_printable(printable)) << printable;
    EXPECT_FALSE(line.starts_with("supervisor  HOLD")) << line;
  }
}

class TextAttack : public testing::TestWithParam<std::string> {};

TEST_P(TextAttack, ShowsVisibleTextInEachTool) {
  Writer stranger{GetParam()};
  const std::vector<std::vector<std::string>> tools{{"status"},
                                                    {"top", "--once"},
                                                    {"topic", "ls", "--window", "3"},
                                                    {"topic", "echo", "event", "--count", "1"},
                                                    {"topic", "echo", "node", "--count", "1"},
                                                    {"topic", "echo", "supervisor", "--count", "3"}};
  const auto all = stranger.watched_by(tools);
  for (std::size_t i = 0; i < tools.size(); ++i) {
    SCOPED_TRACE(tools[i].front() + ' ' + tools[i].back());
    const auto& ended = all[i];
    EXPECT_EQ(ended.exit_code, 0) << ended.errors;
    EXPECT_FALSE(ended.output.empty());
    expect_harmless(ended.output);
    expect_harmless(ended.errors);
  }
}

TEST_P(TextAttack, LeavesTheJsonOfEachToolValid) {
  Writer stranger{GetParam()};
  const std::vector<std::vector<std::string>> tools{{"status", "--json"},
                                                    {"top", "--json"},
                                                    {"topic", "echo", "event", "--count", "1", "--json"},
                                                    {"topic", "echo", "node", "--count", "1", "--json"}};
  const auto all = stranger.watched_by(tools);
  for (std::size_t i = 0; i < tools.size(); ++i) {
    SCOPED_TRACE(tools[i].front() + ' ' + tools[i].at(1));
    const auto& ended = all[i];
    EXPECT_EQ(ended.exit_code, 0) << ended.errors;
    EXPECT_TRUE(nlohmann::json::accept(ended.output)) << ended.output;
    expect_harmless(ended.output);
  }
}

TEST_P(TextAttack, NamesAProgramOfAnotherVersionInVisibleText) {
  Writer stranger{GetParam(), crane_MESSAGES_VERSION + 1};
  const auto ended = stranger.watched_by({{"topic", "echo", "reference", "--duration", "1"}}).front();
  EXPECT_NE(ended.errors.find("has messages of version"), std::string::npos) << ended.errors;
  expect_harmless(ended.errors);
}

INSTANTIATE_TEST_SUITE_P(Vendors, TextAttack, testing::Values("cyclone", "fastdds"),
                         [](const auto& vendor) { return vendor.param; });

}  // namespace
}  // namespace crane::hostile
