#include "campaign/bench.hpp"

#include <cmath>
#include <cstring>
#include <utility>

#include "crane/bridge/bridge.hpp"
#include "crane/bus/seal.hpp"
#include "crane/runtime/in_process.hpp"
#include "stack/stack.hpp"

namespace crane::campaign {
namespace {

constexpr double kSelfTest_s = 1.3, kCausesClear_s = 1.1, kLongest_s = 20;
// Start-up numbers of the components: 1, and from kRestarted on for those that were started anew. Whoever has
// another is no part of the stack.
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
      world_{std::make_shared<World>(setting_.told, setting_.wired)},
      period_ns_{std::llround(setting_.told.period_s * 1e9)},
      next_epoch_{kRestarted} {
  auto specs = stack::stack_with(stack::Plant::simulated);
  building_ = this;  // a specification holds a function without a context
  specs.front().make = [](const runtime::Context& context) -> std::unique_ptr<runtime::Component> {
    return std::make_unique<bridge::Bridge>(context, std::make_unique<FaultyBoard>(building_->world_));
  };
  stack_.emplace(specs, setting_.told, *setting_.controller);
  bus::set_wire(*stack_->network(), [this](const auto& topic, const void* sample,
                                           const bus::Deliver& deliver) { carry(topic, sample, deliver); });
  bus_.emplace(runtime::memory_options(stack_->network(), "operator", crane_SOURCE_OPERATOR));
  operator_.emplace(*bus_, "campaign", 1);
  next_ns_ = stack_->now_ns();
}

void Bench::carry(const topics::Description& topic, const void* sample, const bus::Deliver& deliver) {
  const auto& header = as<msg::Header>(sample);
  if (mad && is_ours(header)) {
    copy_.resize(topic.descriptor->m_size / sizeof(std::max_align_t) + 1);
    std::memcpy(copy_.data(), sample, topic.descriptor->m_size);
    if (mad(topic, copy_.data())) {
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

/// What is published, before any fault of the network.
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
  row_.reset_asked = std::exchange(reset_sent_, false);
  row_.arm_asked = std::exchange(arm_sent_, false);
  stack_->run_until(next_ns_);
  world_->board().advance_to(next_ns_ - 1'000'000'000);  // nature goes on when the bridge does not
  row_.time_ns = next_ns_;
  row_.truth = world_->truth();
  next_ns_ += period_ns_;
  stack_->run_until(next_ns_ - 1);
  rows_.push_back(row_);
}

void Bench::run(double seconds) {
  for (auto left = std::llround(seconds / setting_.told.period_s); left > 0; --left) tick();
}

bool Bench::run_until(const std::function<bool()>& holds, double longest_s) {
  for (auto left = std::llround(longest_s / setting_.told.period_s); left > 0; --left) {
    if (holds()) return true;
    tick();
  }
  return holds();
}

void Bench::ask(const stack::Wish& wish) {
  last_request_ = operator_->send(wish);
  note(wish.kind);
  tick();
}

void Bench::ask_without_number() {
  numberless_.emplace(*bus_, "campaign", 0);
  stack::Wish wish{.kind = crane_REQUEST_MOVE, .selected = setting_.selected, .target = setting_.target};
  last_request_ = numberless_->send(wish);
  tick();
}

void Bench::send(crane_RequestKind kind) {
  last_request_ = operator_->send({.kind = kind});
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

void Bench::ask(crane_RequestKind kind) { ask(stack::Wish{.kind = kind}); }

void Bench::ask_for_the_move() {
  ask(stack::Wish{.kind = crane_REQUEST_MOVE, .selected = setting_.selected, .target = setting_.target});
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

/// The first time that the speed of the axis does not grow any more.
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
  ask(crane_REQUEST_RESET);
  run(kCausesClear_s);
  ask(crane_REQUEST_ARM);
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
  ask_for_the_move();
  if (moment == Moment::peak_acceleration) {
    run(kIntoTheMove_s);
    return true;
  }
  if (!reach_cruise()) return false;
  if (moment == Moment::cruise) return true;
  if (moment == Moment::stop) {
    ask(crane_REQUEST_STOP);
    run(kIntoTheStop_s);
    return true;
  }
  const std::size_t i = setting_.axis;
  const double way = std::abs(setting_.target[i] - setting_.told.start.position[i]);
  constexpr double kLastShare = 0.2;
  return run_until([&] { return std::abs(setting_.target[i] - row_.truth.position[i]) < kLastShare * way; },
                   kLongest_s);
}

}  // namespace crane::campaign
