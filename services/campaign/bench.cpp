#include "campaign/bench.hpp"

#include <cmath>
#include <cstring>
#include <utility>

#include "crane/bridge/bridge.hpp"
#include "crane/bus/ledger.hpp"
#include "crane/bus/seal.hpp"
#include "crane/runtime/in_process.hpp"
#include "stack/stack.hpp"

namespace crane::campaign {
namespace {

constexpr double kSelfTest_s = 1.3, kCausesClear_s = 1.1, kLongest_s = 20;
// Start-up numbers of the components: 1 at first, kRestarted and above after a restart. A sample with another
// number is from a foreign writer.
constexpr std::uint32_t kOwnEpoch = 1, kRestarted = 1000;

bool is_ours(const msg::Header& header) { return header.epoch == kOwnEpoch || header.epoch >= kRestarted; }

template <class T>
bool is(const topics::Description& description, const topics::Topic<T>& topic) {
  return description.name == topic.description.name;
}

template <class T>
const T& as(const void* sample) {
  return *static_cast<const T*>(sample);
}

}  // namespace

Bench::Bench(Setting setting)
    : setting_{std::move(setting)},
      rig_{std::make_shared<FaultyRig>(setting_.configured, setting_.actual)},
      period_ns_{std::llround(setting_.configured.period_s * 1e9)},
      next_epoch_{kRestarted} {
  auto specs = stack::stack_with(stack::Plant::simulated);
  building_ = this;  // ComponentSpec::make is a plain function pointer and cannot capture this bench
  specs.front().make = [](const runtime::Context& context) -> std::unique_ptr<runtime::Component> {
    return std::make_unique<bridge::Bridge>(context, std::make_unique<FaultyBoard>(building_->rig_));
  };
  stack_.emplace(specs, setting_.configured, *setting_.controller,
                 setting_.ledger ? bus::Ledger::create() : nullptr);
  bus::set_wire(*stack_->network(), [this](const auto& topic, const void* sample,
                                           const bus::Deliver& deliver) { carry(topic, sample, deliver); });
  bus_.emplace(runtime::memory_options(stack_->network(), "operator", crane_SOURCE_OPERATOR));
  operator_.emplace(*bus_, "campaign", 1);
  next_ns_ = stack_->now_ns();
}

void Bench::carry(const topics::Description& topic, const void* sample, const bus::Deliver& deliver) {
  const auto& header = as<msg::Header>(sample);
  if (publish_fault && is_ours(header)) {
    copy_.resize(topic.descriptor->m_size / sizeof(std::max_align_t) + 1);
    std::memcpy(copy_.data(), sample, topic.descriptor->m_size);
    if (publish_fault(topic, copy_.data())) {
      bus::seal(topic, copy_.data(), header.source, header.epoch);
      sample = copy_.data();
    }
  }
  tap(topic, sample);
  if (wire)
    wire(topic, sample, deliver);
  else
    deliver(sample);
}

/// Records what the components publish, before any fault of the network.
void Bench::tap(const topics::Description& topic, const void* sample) {
  if (!is_ours(as<msg::Header>(sample))) return;
  if (is(topic, topics::state)) row_.state = as<msg::State>(sample);
  if (is(topic, topics::command)) row_.command = as<msg::Command>(sample);
  if (is(topic, topics::reference)) row_.reference = as<msg::Reference>(sample);
  if (is(topic, topics::tracking)) row_.tracking = as<msg::Contribution>(sample);
  if (is(topic, topics::anti_swing)) row_.anti_swing = as<msg::Contribution>(sample);
  if (is(topic, topics::demand)) row_.demand = as<msg::Demand>(sample);
  if (is(topic, topics::supervisor)) row_.status = as<msg::SupervisorStatus>(sample);
}

void Bench::tick() {
  every_tick();
  row_.reset_requested = std::exchange(reset_sent_, false);
  row_.arm_requested = std::exchange(arm_sent_, false);
  stack_->run_until(next_ns_);
  rig_->board().advance_to(next_ns_ -
                           1'000'000'000);  // the simulated rig continues when the bridge has ended
  row_.time_ns = next_ns_;
  row_.truth = rig_->truth();
  next_ns_ += period_ns_;
  stack_->run_until(next_ns_ - 1);
  rows_.push_back(row_);
}

void Bench::run(double seconds) {
  for (auto left = std::llround(seconds / setting_.configured.period_s); left > 0; --left) tick();
}

bool Bench::run_until(const std::function<bool()>& holds, double longest_s) {
  for (auto left = std::llround(longest_s / setting_.configured.period_s); left > 0; --left) {
    if (holds()) return true;
    tick();
  }
  return holds();
}

void Bench::request(stack::OperatorRequest wanted) {
  wanted.newest_status = row_.status.header;
  last_request_ = operator_->send(wanted);
  note(wanted.kind);
  tick();
}

void Bench::request_without_id() {
  without_id_.emplace(*bus_, "campaign", 0);
  stack::OperatorRequest wanted{.kind = crane_REQUEST_MOVE,
                                .selected = setting_.selected,
                                .target = setting_.target,
                                .newest_status = row_.status.header};
  last_request_ = without_id_->send(wanted);
  tick();
}

void Bench::send(crane_RequestKind kind) {
  last_request_ = operator_->send({.kind = kind, .newest_status = row_.status.header});
  note(kind);
}

void Bench::note(crane_RequestKind kind) {
  reset_sent_ = reset_sent_ || kind == crane_REQUEST_RESET;
  arm_sent_ = arm_sent_ || kind == crane_REQUEST_ARM || kind == crane_REQUEST_HOME;
}

void Bench::restart_bridge() {
  building_ = this;
  stack_->restart(crane_SOURCE_PLANT, next_epoch_++);
}

void Bench::request(crane_RequestKind kind) { request(stack::OperatorRequest{.kind = kind}); }

void Bench::request_move() {
  request(stack::OperatorRequest{
      .kind = crane_REQUEST_MOVE, .selected = setting_.selected, .target = setting_.target});
}

std::optional<msg::Reply> Bench::reply() {
  operator_->receive();
  return operator_->take_reply(last_request_, crane_SOURCE_SUPERVISOR);
}

double Bench::speed_of_axis() const { return std::abs(row_.truth.speed[setting_.axis]); }

bool Bench::reach_hold() {
  return run_until([this] { return row_.status.state >= crane_STATE_HOLD; }, 1) &&
         row_.status.state == crane_STATE_HOLD;
}

/// Runs until the axis of the fault moves and its speed no longer increases.
bool Bench::reach_cruise() {
  constexpr double kMoving = 0.03;  // m/s, rad/s
  double fastest = 0;
  return run_until(
      [&] {
        const double v = speed_of_axis();
        const bool over = v > kMoving && v <= fastest;
        fastest = std::max(fastest, v);
        return over;
      },
      kLongest_s);
}

bool Bench::prepare(Moment moment) {
  run(kSelfTest_s);
  request(crane_REQUEST_RESET);
  run(kCausesClear_s);
  request(crane_REQUEST_ARM);
  if (moment == Moment::brake_release)
    return run_until(
        [this] {
          return row_.command.brake_release[0] || row_.command.brake_release[1] ||
                 row_.command.brake_release[2];
        },
        2);
  if (!reach_hold()) return false;
  constexpr double kIdle_s = 0.3, kIntoTheMove_s = 0.12, kIntoTheStop_s = 0.05;
  run(kIdle_s);
  if (moment == Moment::armed_idle) return true;
  request_move();
  if (moment == Moment::peak_acceleration) {
    run(kIntoTheMove_s);
    return true;
  }
  if (!reach_cruise()) return false;
  if (moment == Moment::cruise) return true;
  if (moment == Moment::stop) {
    request(crane_REQUEST_STOP);
    run(kIntoTheStop_s);
    return true;
  }
  const std::size_t i = setting_.axis;
  const double distance = std::abs(setting_.target[i] - setting_.configured.start.position[i]);
  constexpr double kLastShare = 0.2;
  return run_until(
      [&] { return std::abs(setting_.target[i] - row_.truth.position[i]) < kLastShare * distance; },
      kLongest_s);
}

}  // namespace crane::campaign
