/// Submessages of the reliable protocol, and fragments, with the GUID of every writer of a loop topic, for
/// all processes of the loop, with either vendor. Permitted: the crane stops, a process ends. Forbidden:
/// motion, a process that hangs without stopping the crane, memory without bound.
#include <sched.h>

#include <filesystem>
#include <limits>
#include <string>

#include "../system/stranger.hpp"
#include "crane/boards/linked_rig.hpp"
#include "discovery_attack.hpp"

namespace crane::hostile {
namespace {

constexpr std::uint64_t kLargest = std::numeric_limits<std::int64_t>::max();
constexpr std::uint64_t kNegative = std::uint64_t{1} << 63U;
constexpr std::uint64_t kHuge = std::uint64_t{1} << 62U;

/// What the attacker has heard: a sample of a writer, and an acknowledgement for one of the writers of the
/// process that receives the packets.
struct Heard {
  Bytes forged;  ///< message with one DATA submessage: the sample, falsified
  Bytes acknowledgement;
  GuidPrefix prefix{};
  EntityId writer{};
  std::uint64_t number = 0;  ///< of the sample
  std::uint32_t domain = 0;
};
/// The reader delivers a forged sample with a later number when it has received the genuine ones before it.
constexpr std::uint64_t kLater = 60;

std::vector<Bytes> heartbeats(const Heard& heard) {
  std::vector<Bytes> all;
  for (const auto& [first, last] : {std::pair{std::uint64_t{1}, kLargest},
                                    {kHuge, kLargest},
                                    {kLargest, kLargest},
                                    {kLargest, heard.number},
                                    {kNegative, kLargest},
                                    {std::uint64_t{0}, std::uint64_t{0}},
                                    {kNegative, kNegative}})
    all.push_back(heartbeat(heard.prefix, heard.writer, first, last));
  return all;
}

std::vector<Bytes> gaps(const Heard& heard) {
  std::vector<Bytes> all;
  for (const auto& [first, next, bits] : {std::tuple{std::uint64_t{1}, kLargest, 0U},
                                          {heard.number, heard.number + 1'000'000'000, 0U},
                                          {heard.number + 1000, kHuge, 256U},
                                          {kHuge, heard.number, 256U},
                                          {kNegative, kLargest, 32U},
                                          {std::uint64_t{1}, std::uint64_t{2}, 100'000U},
                                          {kLargest, kLargest, 256U}})
    all.push_back(gap(heard.prefix, heard.writer, first, next, bits));
  return all;
}

std::vector<Bytes> acknowledgements(const Heard& heard) {
  std::vector<Bytes> all;
  for (const auto first : {std::uint64_t{0}, std::uint64_t{1}, kHuge, kLargest, kNegative})
    for (const std::uint32_t count : {0x7E000000U, 0xFFFFFFFFU}) {
      Bytes message(heard.acknowledgement.begin(), heard.acknowledgement.begin() + kHeaderBytes);
      for (const auto& submessage : submessages(heard.acknowledgement)) {
        if (submessage.kind != kAckNack) continue;
        const auto at = heard.acknowledgement.begin() + static_cast<std::ptrdiff_t>(submessage.content);
        append(message, kAckNack, 0, repeat_all({at, at + 8}, first, count));
      }
      all.push_back(message);
    }
  return all;
}

/// Forged samples under other times, destinations and sources.
std::vector<Bytes> contexts(const Heard& heard) {
  constexpr std::uint8_t kInfoSource = 0x0C, kInfoDestination = 0x0E;
  const auto own = header(heard.prefix), foreign = header(GuidPrefix{1, 2, 3});
  const Bytes first(8), last(8, 0xFF), nobody(12), other(12, 0xAB);
  std::vector<Bytes> all;
  auto number = heard.number + kLater;
  for (const auto& [head, kind, content] : {std::tuple{own, std::uint8_t{kInfoTime}, first},
                                            {own, std::uint8_t{kInfoTime}, last},
                                            {own, std::uint8_t{kInfoTime}, Bytes{}},
                                            {own, kInfoDestination, nobody},
                                            {own, kInfoDestination, other},
                                            {own, kInfoDestination, Bytes{}},
                                            {foreign, kInfoSource, source(heard.prefix)},
                                            {foreign, kInfoSource, Bytes{}}}) {
    auto data = heard.forged;
    set_sequence_number(data, submessages(data).front(), number++);
    auto message = head;
    append(message, kind, 0, content);
    message.insert(message.end(), data.begin() + kHeaderBytes, data.end());
    all.push_back(message);
  }
  return all;
}

/// Forged samples: a whole one as its only fragment, and one in overlapping fragments out of order. Then
/// fragments whose sizes, numbers and contents contradict each other.
std::vector<Bytes> fragments(const Heard& heard) {
  std::vector<Bytes> all;
  auto number = heard.number + kLater;
  const auto add = [&](const Fragment& wanted) {
    all.push_back(fragment(heard.prefix, heard.writer, number, wanted));
  };
  auto whole = heard.forged;
  const auto payload = payload_of(whole, submessages(whole).front());
  const Bytes sample(payload.begin(), payload.end());
  const auto size = static_cast<std::uint32_t>(sample.size());
  // Cyclone DDS requires fragments of more than 1024 bytes.
  add({.bytes = 2048, .sample_bytes = size, .payload = sample});
  ++number;
  constexpr std::uint16_t kPiece = 32;
  const std::uint32_t pieces = (size + kPiece - 1) / kPiece;
  for (std::uint32_t i = pieces; i > 0; --i) {
    const auto begin = (i - 1) * kPiece;
    Bytes piece(sample.begin() + begin, sample.begin() + std::min(size, begin + kPiece));
    add({.number = i, .bytes = kPiece, .sample_bytes = size, .payload = piece});
    for (auto& byte : piece) byte ^= 0x40U;
    add({.number = i, .bytes = kPiece, .sample_bytes = size, .payload = piece});
    add({.number = i, .bytes = kPiece, .sample_bytes = size, .payload = {sample.begin(), sample.end()}});
  }
  ++number;
  for (const std::uint32_t sample_bytes : {0U, 1U, 1023U, 65'536U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU})
    for (const std::uint32_t first : {0U, 1U, 2U, 0x7FFFFFFFU, 0xFFFFFFFFU})
      for (const int count : {0, 1, 2, 0xFFFF})
        for (const int bytes : {0, 1, 1024, 0xFFFF})
          add({.number = first,
               .count = static_cast<std::uint16_t>(count),
               .bytes = static_cast<std::uint16_t>(bytes),
               .sample_bytes = sample_bytes});
  return all;
}

/// The writer's participant, and that of a reader, with locators that lead nowhere; then their ends.
std::vector<Bytes> announcements(const Heard& heard) {
  std::vector<Bytes> all;
  for (const auto& prefix : {heard.prefix, prefix_of(heard.acknowledgement)})
    for (int i = 0; i < 100; ++i) all.push_back(participant(prefix, heard.domain));
  for (const auto& prefix : {heard.prefix, prefix_of(heard.acknowledgement)})
    all.push_back(end_of_participant(prefix));
  return all;
}

struct Attack {
  const char* name;
  std::vector<Bytes> (*packets)(const Heard&);
  const char* vendor = "cyclone";
  bool real_time = true;  ///< false: the kernel does not end a process that computes without end
};
std::ostream& operator<<(std::ostream& out, const Attack& attack) {
  return out << attack.name << " with " << attack.vendor << (attack.real_time ? "" : ", without real time");
}

class ProtocolAttack : public DiscoveryAttack,
                       public testing::WithParamInterface<std::tuple<Attack, LoopRoute>> {
 protected:
  static constexpr const char* kCardRig = "emulated_servo_to_go";
  void SetUp() override {
    if (!Ear::permitted()) GTEST_SKIP() << "listening on the loop-back interface needs CAP_NET_RAW";
    auto options = system_test::launch_options(kDomain, kCardRig);
    options.bus.vendor = attack_.vendor;
    ASSERT_NO_FATAL_FAILURE(start(options, stack::Plant::hardware));
    monitor_.emplace(bridge::shared_lines_name(options.bus.crane, kDomain));
  }
  [[nodiscard]] const char* reader() const {
    const std::string_view name = std::get<1>(GetParam()).reader;
    return name == "plant" ? "hardware_bridge" : name.data();
  }
  Heard hear() {
    Heard result;
    result.domain = kDomain;
    result.acknowledgement =
        heard(reader(), [](const Bytes& message) {
          return std::ranges::any_of(submessages(message), [](const auto& s) { return s.kind == kAckNack; });
        }).message;
    system_test::with_forgery_of(std::get<1>(GetParam()).topic, [&](const auto& topic, auto spoil) {
      auto packet = heard(reader(), topic);
      const auto data = find(packet.message, topic).value().data;
      result.prefix = prefix_of(packet.message);
      result.writer = entities_of(packet.message, data).writer;
      result.number = sequence_number_of(packet.message, data);
      result.forged = alone(packet.message, data);
      auto found = find(result.forged, topic).value();
      spoil(found.sample);
      found.sample.header.tick += kLater;
      replace(result.forged, found.data, topic, found.sample);
    });
    return result;
  }
  /// Sends all packets repeatedly for one and a half seconds.
  void attack() {
    const auto packets = attack_.packets(hear());
    begin_ns_ = runtime::monotonic_ns();
    const auto end = std::chrono::steady_clock::now() + 1500ms;
    for (std::size_t i = 0; std::chrono::steady_clock::now() < end; ++i) {
      send_to(reader(), packets[i % packets.size()]);
      if (i % 20 == 0) stack_->listen(5ms);
      farthest_m_ = std::max(farthest_m_, std::abs(trolley_m() - begin_m_));
    }
    stack_->listen(300ms);
  }
  /// Gives all threads of the attacked process ordinary scheduling.
  void end_real_time() {
    const auto process = std::to_string(stack_->children().pid_of(reader()).value());
    for (const auto& thread : std::filesystem::directory_iterator{"/proc/" + process + "/task"}) {
      constexpr sched_param kOrdinary{};
      ASSERT_EQ(::sched_setscheduler(std::stoi(thread.path().filename()), SCHED_OTHER, &kOrdinary), 0);
    }
  }
  /// True position of the trolley.
  [[nodiscard]] double trolley_m() const {
    return static_cast<double>(monitor_->lines().pulses[0]) /
           configuration::load_rig(stack::find_rig(kCardRig)).encoders[0].counts_per_unit;
  }
  [[nodiscard]] bool brakes_have_closed() const { return monitor_->lines().brakes_closed_ns > begin_ns_; }

  const Attack attack_ = std::get<0>(GetParam());
  std::optional<bridge::RigMonitor> monitor_;
  std::int64_t begin_ns_ = 0;
  double begin_m_ = 0, farthest_m_ = 0;
};

TEST_P(ProtocolAttack, EndsInHoldOrWithClosedBrakes) {
  stack_->session().arm();
  if (!attack_.real_time) end_real_time();
  begin_m_ = trolley_m();
  const auto memory_kb = [this] { return resident_kb(stack_->children().pid_of(reader()).value_or(0)); };
  const long before_kb = memory_kb();
  attack();
  const bool stopped = brakes_have_closed();
  if (stopped)
    std::cout << "brakes closed after " << (monitor_->lines().brakes_closed_ns - begin_ns_) / 1'000'000
              << " ms; ";
  std::cout << experiments::in_words(stack_->observer().statuses().back()) << '\n';
  while (const auto ended = stack_->children().ended()) std::cout << stack::describe(*ended) << '\n';
  constexpr long kGrowth_kb = 16 * 1024;
  EXPECT_LE(memory_kb() - before_kb, kGrowth_kb);
  if (!stopped) {
    EXPECT_TRUE(is(crane_STATE_HOLD));
    stack_->session().request({.kind = crane_REQUEST_ESTOP}, "estop");
    EXPECT_TRUE(stack_->until([this] { return brakes_have_closed(); }, 1s)) << "no control, brakes open";
  }
  std::cout << "trolley moved by " << farthest_m_ << " m, memory grew by "
            << std::max(0L, memory_kb() - before_kb) << " kB\n";
  EXPECT_LE(farthest_m_, kStill_m);
}

std::string name_of(const testing::TestParamInfo<std::tuple<Attack, LoopRoute>>& test) {
  const auto& [attack, route] = test.param;
  return std::string{attack.name} + "_" + attack.vendor + (attack.real_time ? "_" : "_without_real_time_") +
         route.topic;
}
constexpr Attack kAttacks[] = {{"announcements", announcements},
                               {"announcements", announcements, "fastdds"},
                               {"heartbeats", heartbeats},
                               {"gaps", gaps},
                               {"acknowledgements", acknowledgements},
                               {"contexts", contexts},
                               {"fragments", fragments},
                               {"heartbeats", heartbeats, "fastdds"},
                               {"gaps", gaps, "fastdds"},
                               {"gaps", gaps, "fastdds", false},
                               {"acknowledgements", acknowledgements, "fastdds"},
                               {"contexts", contexts, "fastdds"},
                               {"fragments", fragments, "fastdds"}};
/// One topic for each kind of reader: bridge, supervisor, a controller, planner.
constexpr LoopRoute kRoutes[] = {kLoopRoutes[0], kLoopRoutes[1], kLoopRoutes[3], kLoopRoutes[6]};
/// Each attack on one route, each route with a third of the attacks; the other pairs are Long tests.
std::vector<std::tuple<Attack, LoopRoute>> pairs(bool usual) {
  std::vector<std::tuple<Attack, LoopRoute>> chosen;
  for (std::size_t attack = 0; attack < std::size(kAttacks); ++attack)
    for (std::size_t route = 0; route < std::size(kRoutes); ++route)
      if (((attack + route) % std::size(kRoutes) == 0) == usual)
        chosen.emplace_back(kAttacks[attack], kRoutes[route]);
  return chosen;
}
INSTANTIATE_TEST_SUITE_P(Of, ProtocolAttack, testing::ValuesIn(pairs(true)), name_of);
INSTANTIATE_TEST_SUITE_P(LongOf, ProtocolAttack, testing::ValuesIn(pairs(false)), name_of);

}  // namespace
}  // namespace crane::hostile
