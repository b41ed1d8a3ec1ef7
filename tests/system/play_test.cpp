// crane play on both vendors: viewers receive the recorded samples at their times; the readers of the loop
// accept no sample; a crane is never disturbed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <map>
#include <thread>

#include "../replay/recorded_crane.hpp"
#include "crane/bus/cdr.hpp"
#include "crane/runtime/loop_reader.hpp"
#include "program_run.hpp"
#include "running_stack.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr std::uint32_t kDomain = 80;
const auto kCrane = stack::program_directory() / "crane";

/// A recorded move of a second after arming, with requests.
class Play : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    replay_test::RecordedCrane crane{file_, "virginia_tech_tower", "gain_scheduling_partial"};
    crane.arm();
    crane.ask({.kind = crane_REQUEST_MOVE, .selected = {true, false, false}, .target = {0.8, 0, 0}});
    crane.run(1);
    ticks_ = crane.finish();
  }
  [[nodiscard]] runtime::BusOptions bus_options(const std::string& vendor = GetParam()) const {
    runtime::BusOptions options;
    options.vendor = vendor;
    options.domain = kDomain;
    options.crane = name_;
    return options;
  }
  [[nodiscard]] bus::Bus bus(crane_Source source, const std::string& vendor = GetParam()) const {
    return bus::Bus{runtime::bus_options(bus_options(vendor), "play_test", source, 1)};
  }
  [[nodiscard]] std::vector<std::string> arguments(std::vector<std::string> more = {}) const {
    std::vector<std::string> all{"play", file_.string()};
    all.insert(all.end(), more.begin(), more.end());
    const auto where = runtime::arguments(bus_options());
    all.insert(all.end(), where.begin(), where.end());
    return all;
  }
  [[nodiscard]] Ended play(std::vector<std::string> more) const {
    return run_program(kCrane, arguments(std::move(more)));
  }

  recording::TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_ / "run.mcap";
  std::string name_ = crane_name();
  std::uint64_t ticks_ = 0;
};

/// Everything that a bus delivers while a program runs.
class Audience {
 public:
  explicit Audience(bus::Bus bus) : bus_{std::move(bus)} {
    for (const auto& topic : topics::kAll) readers_.push_back(bus_.cdr_subscriber(topic));
  }
  void listen_until_end(ProgramRun& program) {
    const auto give_up = std::chrono::steady_clock::now() + 30s;
    std::optional<int> ended;
    while (!ended && std::chrono::steady_clock::now() < give_up) {
      take();
      ended = program.wait(1ms);
    }
    for (int i = 0; i < 20; ++i) take();
    EXPECT_EQ(ended, 0) << program.errors();
  }
  void take() {
    bus_.wait(5ms);
    std::vector<std::uint8_t> cdr;
    for (auto& reader : readers_)
      while (const auto header = reader.take(cdr)) {
        EXPECT_EQ(header->source, crane_SOURCE_MONITOR);
        samples_[std::string{reader.topic().name}].emplace_back(header->tick, cdr);
      }
  }
  using Samples = std::vector<std::pair<std::uint64_t, std::vector<std::uint8_t>>>;
  [[nodiscard]] const Samples& of(const std::string& topic) { return samples_[topic]; }
  [[nodiscard]] std::size_t topics() const { return samples_.size(); }

 private:
  bus::Bus bus_;
  std::vector<bus::CdrSubscriber> readers_;
  std::map<std::string, Samples> samples_;
};

/// The bytes without source, epoch and CRC.
std::vector<std::uint8_t> content_of(std::vector<std::uint8_t> cdr) {
  std::fill_n(cdr.begin() + 4 + 16, 8, std::uint8_t{0});
  cdr.resize(cdr.size() - 4);
  return cdr;
}

TEST_P(Play, DeliversTheRecordedSamplesInTheirTimeToBothVendors) {
  constexpr double kFrom_s = 1, kTo_s = 3, kRate = 2;
  Audience same{bus(crane_SOURCE_MONITOR)};
  Audience other{bus(crane_SOURCE_MONITOR, std::string{GetParam()} == "cyclone" ? "fastdds" : "cyclone")};
  ProgramRun program{kCrane, arguments({"--from", "1", "--to", "3", "--rate", "2"})};
  ASSERT_TRUE(program.wait_for_error("playing", 20s)) << program.errors();
  const auto begin = std::chrono::steady_clock::now();
  std::atomic<bool> ended = false;
  std::thread listener{[&] {
    while (!ended) other.take();
  }};
  same.listen_until_end(program);
  ended = true;
  listener.join();
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
  EXPECT_GT(passed.count(), (kTo_s - kFrom_s) / kRate - 0.1);
  EXPECT_THAT(program.output(), HasSubstr("1400 samples played"));  // seven topics, 200 ticks

  std::map<std::uint64_t, std::vector<std::uint8_t>> recorded;
  recording::McapReader reader{file_};
  reader.for_each({.topics = {"crane/demand"}}, [&](const recording::Message& message) {
    recorded[message.sequence] = {message.data.begin(), message.data.end()};
    return true;
  });
  for (auto* audience : {&same, &other}) {
    const auto& demands = audience->of("crane/demand");
    ASSERT_GT(demands.size(), 150U) << "discovery may take the first samples";
    for (std::size_t i = 0; i < demands.size(); ++i) {
      EXPECT_EQ(demands[i].first, demands.front().first + i);
      EXPECT_EQ(content_of(demands[i].second), content_of(recorded.at(demands[i].first)));
    }
    EXPECT_EQ(demands.back().first, 299U);
    EXPECT_TRUE(audience->of("crane/request").empty());
  }
}

TEST_P(Play, RepeatsOnlyTheGivenTopic) {
  Audience audience{bus(crane_SOURCE_MONITOR)};
  ProgramRun program{kCrane, arguments({"--topic", "crane/state", "--to", "0.2", "--rate", "4", "--loop"})};
  ASSERT_TRUE(program.wait_for_error("playing", 20s)) << program.errors();
  const auto give_up = std::chrono::steady_clock::now() + 10s;
  while (audience.of("crane/state").size() < 60 && std::chrono::steady_clock::now() < give_up)
    audience.take();
  program.send(SIGINT);
  EXPECT_EQ(program.wait(5s), 0);
  EXPECT_GE(audience.of("crane/state").size(), 60U);
  EXPECT_TRUE(audience.of("crane/command").empty());
}

TEST_P(Play, NoReaderOfTheLoopAcceptsASample) {
  auto listening = bus(crane_SOURCE_NONE);
  auto states = runtime::loop_reader(listening, topics::state);
  auto commands = runtime::loop_reader(listening, topics::command);
  auto statuses = runtime::loop_reader(listening, topics::supervisor);
  auto references = runtime::loop_reader(listening, topics::reference);
  std::size_t accepted = 0;
  ProgramRun program{kCrane, arguments({"--from", "1"})};
  ASSERT_TRUE(program.wait_for_error("playing", 20s)) << program.errors();
  const auto take = [&](auto& reader) {
    std::size_t budget = 256;
    while (reader->take(runtime::monotonic_ns(), budget)) ++accepted;
  };
  const auto give_up = std::chrono::steady_clock::now() + 20s;
  for (std::optional<int> ended; !ended && std::chrono::steady_clock::now() < give_up;
       ended = program.wait(1ms)) {
    listening.wait(5ms);
    take(states);
    take(commands);
    take(statuses);
    take(references);
  }
  EXPECT_EQ(accepted, 0U);
  EXPECT_GT(states->binding().foreign(), 50U) << "samples arrived and were dropped";
  EXPECT_GT(commands->binding().foreign(), 50U);
  for (const auto& topic : topics::kAll) EXPECT_FALSE(topics::may_write(topic, crane_SOURCE_MONITOR));
}

TEST_P(Play, RefusesABusWithACraneAndDoesNotDisturbTheCrane) {
  RunningStack running{kDomain, "virginia_tech_tower"};
  running.session().arm();
  ASSERT_TRUE(running.until(
      [&] {
        const auto& statuses = running.observer().statuses();
        return !statuses.empty() && statuses.back().state == crane_STATE_HOLD;
      },
      5s));
  running.forget();
  name_ = running.bus_options().crane;
  const auto refused = play({});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.errors, HasSubstr("another program writes crane/"));
  EXPECT_EQ(refused.output, "");
  running.listen(1s);
  ASSERT_FALSE(running.observer().statuses().empty());
  for (const auto& status : running.observer().statuses()) {
    EXPECT_EQ(status.state, crane_STATE_HOLD);
    EXPECT_FALSE(status.second_writer);
  }
}

TEST_P(Play, StopsAtOnceWhenAnotherWriterAppears) {
  for (const std::string vendor : {"cyclone", "fastdds"}) {
    SCOPED_TRACE(vendor);
    ProgramRun program{kCrane, arguments({"--loop", "--topic", "crane/state"})};
    ASSERT_TRUE(program.wait_for_error("playing", 20s)) << program.errors();
    EXPECT_FALSE(program.wait(1s)) << program.errors();
    auto supervisor = bus(crane_SOURCE_SUPERVISOR, vendor);
    const auto writer = supervisor.publisher(topics::command);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(program.wait(5s), 1);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    std::cout << "stopped after " << passed.count() << " s, including discovery\n";
    EXPECT_LT(passed.count(), 2);
    EXPECT_THAT(program.errors(), HasSubstr("another program writes crane/command: stopped"));
  }
}

TEST_P(Play, PreventsTheStartOfAStack) {
  ProgramRun program{kCrane, arguments({"--loop"})};
  ASSERT_TRUE(program.wait_for_error("playing", 20s)) << program.errors();
  EXPECT_FALSE(program.wait(500ms)) << program.errors();
  std::vector<std::string> up{"up", "--no-black-box"};
  for (const auto& word : runtime::arguments(bus_options())) up.push_back(word);
  const auto started = run_program(kCrane, up);
  EXPECT_EQ(started.exit_code, 1);
  EXPECT_THAT(started.errors, HasSubstr("another process already writes crane/"));
}

TEST_P(Play, RefusesKeysRequestsAndEmptyRanges) {
  const auto refused = play({"--topic", "crane/request", "--secure", directory_ / "keys"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr("--topic crane/request: cannot be played"));
  EXPECT_THAT(refused.errors, HasSubstr("--secure: a recording is not played on a bus with keys"));
  EXPECT_EQ(play({"--topic", "crane/jog"}).exit_code, 2);
  EXPECT_EQ(play({"--from", "100"}).exit_code, 2);
  EXPECT_EQ(play({"--rate", "0"}).exit_code, 2);
  const auto open = play({"--interface", "192.0.2.1"});
  EXPECT_EQ(open.exit_code, 2);
  EXPECT_THAT(open.errors, HasSubstr("--insecure"));
}

INSTANTIATE_TEST_SUITE_P(Vendors, Play, testing::Values("cyclone", "fastdds"),
                         [](const auto& vendor) { return std::string{vendor.param}; });

}  // namespace
}  // namespace crane::system_test
