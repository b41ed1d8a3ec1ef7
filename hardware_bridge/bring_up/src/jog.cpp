#include "crane/bring_up/jog.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "crane/bring_up/wiring.hpp"

namespace crane::bring_up {
namespace {

using Volts = std::array<double, kDrives>;

bool new_limit(const bridge::Inputs& before, const bridge::Inputs& now) {
  for (std::size_t i = 0; i < kDrives; ++i)
    if ((now.limit_low[i] && !before.limit_low[i]) || (now.limit_high[i] && !before.limit_high[i]))
      return true;
  return false;
}

/// Largest motion of a drive since `before`, by its counter, m or rad.
double farthest(const Sample& before, const Sample& now) {
  double distance = 0;
  for (std::size_t i = 0; i < kDrives; ++i)
    distance = std::max(distance, std::abs(now.coordinate[i] - before.coordinate[i]));
  return distance;
}

class Running {
 public:
  Running(Session& session, const JogPlan& plan) : session_{session}, plan_{plan}, first_{session.sample()} {}

  Jog run() {
    session_.close_relay();
    first_ = session_.sample();
    jog_.record.push_back(first_);
    open();
    push();
    close();
    for (std::size_t i = 0; i < kCounters; ++i)
      jog_.moved[i] = session_.sample().coordinate[i] - first_.coordinate[i];
    return std::move(jog_);
  }

 private:
  const Sample& step(const Volts& drive_v, const std::array<bool, kDrives>& release) {
    jog_.record.push_back(session_.tick_driven(drive_v, release));
    return jog_.record.back();
  }

  void open() {
    const auto& drives = session_.rig().drives;
    double longest_s = 0;
    for (const auto& drive : drives) longest_s = std::max(longest_s, drive.brake_open_time_s);
    for (double passed_s = 0; passed_s < longest_s + 0.05; passed_s += session_.rig().period_s)
      step({}, plan_.release);
    for (std::size_t i = 0; i < kDrives; ++i)
      jog_.opened[i] =
          drives[i].present && first_.inputs.brake_closed[i] && !session_.sample().inputs.brake_closed[i];
    jog_.drift = session_.sample().coordinate[plan_.axis] - first_.coordinate[plan_.axis];
  }

  void push() {
    const Sample begin = session_.sample();
    Volts drive_v{};
    drive_v[plan_.axis] = plan_.drive_v;
    for (double passed_s = 0; passed_s < plan_.duration_s; passed_s += session_.rig().period_s) {
      const auto& now = step(drive_v, plan_.release);
      const double distance = farthest(begin, now);
      jog_.limit = new_limit(first_.inputs, now.inputs);
      if (jog_.limit || distance >= plan_.distance || plan_.ends_when(now)) return;
      if (distance < kStandstill && passed_s >= plan_.duration_without_motion_s) return;
    }
  }

  void close() {
    const auto& drive = session_.rig().drives[plan_.axis];
    const double period_s = session_.rig().period_s;
    const double allowed_s = drive.brake_close_time_s + 2 * period_s;
    double passed_s = 0;
    for (; passed_s < allowed_s; passed_s += period_s) step({}, {});
    jog_.closed_again = session_.sample().inputs.brake_closed[plan_.axis];
    // Waits 0.3 s, until the suspension point is at rest; for a brake that closes late, at most 1.5 s.
    for (; passed_s < 0.3 || (passed_s < 1.5 && !session_.sample().inputs.brake_closed[plan_.axis]);
         passed_s += period_s)
      step({}, {});
  }

  Session& session_;
  const JogPlan& plan_;
  Sample first_;
  Jog jog_;
};

}  // namespace

std::vector<std::string> problems(const JogPlan& plan, const configuration::Rig& rig) {
  std::vector<std::string> found;
  char text[120];
  const double limit_v = std::min(kLargestJog_v, rig.drives[plan.axis].volt_limit_v);
  if (!rig.drives[plan.axis].present)
    found.push_back("axis = " + std::string{coordinate_name(plan.axis)} + ": this rig has no such drive");
  if (!(std::abs(plan.drive_v) <= limit_v) || plan.drive_v == 0) {
    std::snprintf(text, sizeof text, "volts = %g: must be in [-%g, %g] and not 0", plan.drive_v, limit_v,
                  limit_v);
    found.emplace_back(text);
  }
  if (!(plan.distance > 0 && plan.distance <= kFarthestJog)) {
    std::snprintf(text, sizeof text, "distance = %g: must be in (0, %g]", plan.distance, kFarthestJog);
    found.emplace_back(text);
  }
  return found;
}

Jog run(Session& session, const JogPlan& plan) { return Running{session, plan}.run(); }

}  // namespace crane::bring_up
