#include "campaign/traffic.hpp"

#include <algorithm>

#include "crane/bus/seal.hpp"
#include "crane/runtime/in_process.hpp"
#include "crane/runtime/node.hpp"

namespace crane::campaign {
namespace {

bus::Options options_of(Bench& bench, crane_Source source, std::uint32_t epoch) {
  auto options = runtime::memory_options(bench.stack().network(), "foreign_writer", source);
  options.epoch = epoch;
  return options;
}

constexpr double kPush_v = 6;

}  // namespace

bus::Wire on(const topics::Description& topic,
             std::function<void(const void* sample, const bus::Deliver& deliver)> fault) {
  return [name = topic.name, fault = std::move(fault)](const topics::Description& published,
                                                       const void* sample, const bus::Deliver& deliver) {
    if (published.name == name)
      fault(sample, deliver);
    else
      deliver(sample);
  };
}

StoredSample::StoredSample(const topics::Description& topic)
    : topic_{topic}, bytes_(topic.descriptor->m_size / sizeof(std::max_align_t) + 1) {}

void StoredSample::keep(const void* sample) {
  std::memcpy(bytes_.data(), sample, topic_.descriptor->m_size);
  full_ = true;
}

const void* StoredSample::take() {
  full_ = false;
  return bytes_.data();
}

void StoredSample::flip(std::size_t bit) {
  auto* bytes = reinterpret_cast<unsigned char*>(bytes_.data());
  bytes[bit / 8] = static_cast<unsigned char>(bytes[bit / 8] ^ (1U << (bit % 8)));
}

void StoredSample::change_value(std::size_t axis) {
  void* sample = bytes_.data();
  if (topic_.name == topics::command.description.name)
    static_cast<msg::Command*>(sample)->drive_v[axis] += kPush_v;
  if (topic_.name == topics::demand.description.name)
    static_cast<msg::Demand*>(sample)->total_v[axis] += kPush_v;
  if (topic_.name == topics::state.description.name)
    static_cast<msg::State*>(sample)->trolley_position_m += 0.5;
}

void StoredSample::seal() {
  const auto header = *reinterpret_cast<const msg::Header*>(bytes_.data());
  bus::seal(topic_, bytes_.data(), header.source, header.epoch);
}

crane_Source right_source(const topics::Description& topic) {
  for (int source = crane_SOURCE_PLANT; source <= crane_SOURCE_TWIN; ++source)
    if (topics::may_write(topic, static_cast<crane_Source>(source))) return static_cast<crane_Source>(source);
  return crane_SOURCE_NONE;
}

ForeignWriter::ForeignWriter(Bench& bench, crane_Source source, std::uint32_t epoch)
    : bus_{options_of(bench, source, epoch)} {}

void ForeignWriter::publish_plausible(const topics::Description& topic, const Bench& bench) {
  const auto send = [&](auto& publisher, const auto& typed, auto sample) {
    if (typed.description.name != topic.name) return;
    if (!publisher) publisher.emplace(bus_.publisher(typed));
    sample.header.tick = bench.now().state.header.tick;
    (void)publisher->publish(sample);
  };
  msg::Command command = bench.now().command;
  for (std::size_t i = 0; i < kAxes; ++i) {
    command.drive_v[i] = kPush_v;
    command.brake_release[i] = true;
  }
  command.watchdog_permission = true;
  msg::Demand demand{};
  for (double& v : demand.total_v) v = kPush_v;
  send(states_, topics::state, bench.now().state);
  send(references_, topics::reference, msg::Reference{});
  send(tracking_, topics::tracking, msg::Contribution{});
  send(anti_swing_, topics::anti_swing, msg::Contribution{});
  send(demands_, topics::demand, demand);
  send(commands_, topics::command, command);
}

void ForeignWriter::flood_requests(const Bench& bench, std::size_t count, bool later) {
  if (!requests_) requests_.emplace(bus_.publisher(topics::request));
  for (std::size_t i = 0; i < count; ++i) {
    msg::Request request{};
    request.header.tick = bench.now().state.header.tick;
    request.id = next_id_++;
    runtime::assign(request.client, "flood");
    request.kind = crane_REQUEST_MOVE;
    request.apply_tick = later ? bench.now().state.header.tick + 100'000 : 0;
    (void)requests_->publish(request);
  }
}

}  // namespace crane::campaign
