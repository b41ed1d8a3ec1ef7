#include "cli/player.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include "crane/runtime/process.hpp"

namespace crane::cli {

bool may_play(const topics::Description& topic) {
  return topic.name != topics::request.description.name && topic.name != topics::jog.description.name;
}

OtherWriters::OtherWriters(const bus::Options& options) {
  for (const auto vendor : {bus::Vendor::cyclone, bus::Vendor::fastdds}) {
    auto with_vendor = options;
    with_vendor.vendor = vendor;
    auto& bus = buses_.emplace_back(with_vendor);
    for (const auto& topic : topics::kAll)
      if (topic.every_tick) readers_.push_back(bus.cdr_subscriber(topic));
  }
}

int OtherWriters::own(const topics::Description& topic) const {
  const auto found = own_.find(topic.name);
  return found == own_.end() ? 0 : found->second;
}

std::optional<std::string> OtherWriters::find() const {
  for (const auto& reader : readers_)
    if (reader.matched() > own(reader.topic())) return std::string{reader.topic().name};
  return std::nullopt;
}

void OtherWriters::refuse_other_version() {
  for (auto& bus : buses_) runtime::refuse_other_version(bus);
}

Player::Player(const bus::Options& options, recording::McapReader& recording,
               const std::vector<const topics::Description*>& topics)
    : bus_{options}, recording_{recording}, others_{options} {
  // Discovery between vendors takes up to a second. The player waits longer, because its writers would stop a
  // crane that it has not discovered.
  constexpr std::int64_t kLook_ns = 2'000'000'000, kDiscovery_ns = 1'500'000'000;
  look_for_others(kLook_ns);
  for (const auto* topic : topics) {
    others_.except(*topic);
    publishers_.emplace(topic->name, bus_.cdr_publisher(*topic));
  }
  look_for_others(kDiscovery_ns);
}

void Player::look_for_others(std::int64_t duration_ns) {
  const auto end_ns = runtime::monotonic_ns() + duration_ns;
  while (runtime::monotonic_ns() < end_ns && !runtime::stop_requested()) {
    others_.refuse_other_version();
    if (const auto topic = others_.find())
      throw bus::Error("another program writes " + *topic + " of crane '" + bus_.options().crane +
                       "' in domain " + std::to_string(bus_.options().domain) +
                       ": stop that stack first, or choose another --crane or --domain");
    bus_.wait(std::chrono::milliseconds{10});
  }
}

bool Player::is_alone(std::int64_t now_ns) {
  constexpr std::int64_t kEvery_ns = 1'000'000;
  if (now_ns - looked_ns_ < kEvery_ns) return true;
  looked_ns_ = now_ns;
  other_writer_ = others_.find();
  return !other_writer_;
}

bool Player::wait_for(std::int64_t due_ns) {
  constexpr std::int64_t kLongest_ns = 2'000'000;
  for (auto now_ns = runtime::monotonic_ns();; now_ns = runtime::monotonic_ns()) {
    if (runtime::stop_requested() || !is_alone(now_ns)) return false;
    if (now_ns >= due_ns) return true;
    std::this_thread::sleep_for(std::chrono::nanoseconds{std::min(due_ns - now_ns, kLongest_ns)});
  }
}

bool Player::play(const recording::Selection& selection, std::int64_t begin_ns, double rate) {
  const auto started_ns = runtime::monotonic_ns();
  auto messages = recording_.messages(selection);
  while (const auto* message = messages.next()) {
    const auto publisher = publishers_.find(message->channel->topic);
    if (publisher == publishers_.end()) continue;
    const double passed_ns = static_cast<double>(message->log_time_ns - begin_ns) / rate;
    if (!wait_for(started_ns + std::llround(passed_ns))) return false;
    ++(publisher->second.publish(message->data) ? counts_.played : counts_.failed);
  }
  return true;
}

void Player::finish() const {
  constexpr std::chrono::milliseconds kDelivery{300};  // fifteen heartbeats
  if (!other_writer_) std::this_thread::sleep_for(kDelivery);
}

}  // namespace crane::cli
