#include "crane/bring_up/session.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "crane/bridge/start_counts.hpp"
#include "crane/plant/coordinates.hpp"

namespace crane::bring_up {

std::string_view coordinate_name(std::size_t coordinate) { return plant::kCoordinates.at(coordinate).name; }

std::string_view coordinate_unit(std::size_t coordinate) { return plant::kCoordinates.at(coordinate).unit; }

Session::Session(const configuration::Rig& rig, bridge::Board& board, Clock clock)
    : rig_{rig}, board_{board}, clock_{std::move(clock)}, period_ns_{std::llround(rig.period_s * 1e9)} {
  board_.make_safe();
  const auto start = bridge::start_counts(rig);
  for (std::size_t i = 0; i < kCounters; ++i) unwrapper_[i] = bridge::CountUnwrapper{start[i]};
  take(board_.read());
}

Session::~Session() { board_.make_safe(); }

void Session::take(const bridge::Inputs& inputs) {
  sample_.time_s = static_cast<double>(time_ns_) * 1e-9;
  sample_.inputs = inputs;
  for (std::size_t i = 0; i < kCounters; ++i) {
    const auto& encoder = rig_.encoders[i];
    sample_.counts[i] = unwrapper_[i].step(inputs.raw_counts[i]);
    sample_.coordinate[i] = encoder.counts_per_unit > 0 ? static_cast<double>(sample_.counts[i]) *
                                                                  encoder.sign / encoder.counts_per_unit -
                                                              encoder.rest_angle_rad
                                                        : 0;
  }
}

const Sample& Session::tick(const bridge::Outputs& outputs) {
  if (clock_.interrupted()) end("interrupted");
  board_.write(outputs);
  clock_.wait(period_ns_);
  time_ns_ += period_ns_;
  board_.advance_to(time_ns_);
  take(board_.read());
  return sample_;
}

const Sample& Session::tick_braked() {
  level_ = relay_closed_ = false;
  return tick({});
}

const Sample& Session::tick_driven(const std::array<double, kDrives>& drive_v,
                                   const std::array<bool, kDrives>& release) {
  level_ = !level_;
  bridge::Outputs outputs{drive_v, release, level_};
  for (std::size_t i = 0; i < kDrives; ++i) outputs.drive_v[i] *= rig_.drives[i].sign;
  const auto begin_ns = clock_.now_ns();
  tick(outputs);
  const double passed_s = static_cast<double>(clock_.now_ns() - begin_ns) * 1e-9;
  const bool opened = std::exchange(relay_closed_, !sample_.inputs.watchdog_dropped) && !relay_closed_;
  if (sample_.inputs.estop_pressed) end("the emergency stop is pressed");
  if (opened || passed_s > std::max(rig_.wiring.relay_timeout_s, 2 * rig_.period_s))
    end("the watchdog relay has opened, because this program was suspended or the computer was too busy");
  return sample_;
}

void Session::end(const std::string& why) {
  board_.make_safe();
  throw Ended(why + "; 0 V, brakes closed");
}

Record Session::record_braked(double duration_s) {
  Record record;
  for (double passed_s = 0; passed_s < duration_s; passed_s += rig_.period_s) record.push_back(tick_braked());
  return record;
}

void Session::close_relay() {
  constexpr double kCharging_s = 0.2;  // longest time of the charge pump until its relay closes
  for (double passed_s = 0; passed_s < kCharging_s; passed_s += rig_.period_s) tick_driven({}, {});
}

}  // namespace crane::bring_up
