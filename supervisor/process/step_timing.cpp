#include "process/step_timing.hpp"

#include <algorithm>

namespace crane::supervisor {
namespace {

constexpr double kSilentPeriods = 1.5;             // longest wait for a state after the last sample
constexpr double kDemandPeriods = 2;               // additional wait for the demand of an arrived state
constexpr double kExtensionPeriods = 0.5;          // extension after a late step or a late wake-up
constexpr std::int64_t kStart_ns = 2'000'000'000;  // longest wait for the first tick with all inputs

}  // namespace

bool StepTiming::begins(bool complete, std::int64_t now_ns) {
  if (begun_ || clock_ != runtime::Clock::realtime) return true;
  if (state_due_ns_ == runtime::kNever) state_due_ns_ = now_ns + kStart_ns;
  begun_ = complete || now_ns >= state_due_ns_;
  return begun_;
}

void StepTiming::stepped(std::int64_t sampled_ns, std::int64_t now_ns) {
  if (clock_ == runtime::Clock::prescribed) return expect_state_by(now_ns + 1);
  expect_state_by(std::max(sampled_ns + periods_ns(kSilentPeriods), now_ns + periods_ns(kExtensionPeriods)));
}

bool StepTiming::is_silent(bool open, std::int64_t now_ns) {
  const auto due = due_ns(open);
  if (now_ns < due) return false;
  if (clock_ == runtime::Clock::prescribed) {
    expect_state_by(now_ns + 1);
    return true;
  }
  if (!wait_extended_ && !open && now_ns >= due + periods_ns(kExtensionPeriods) / 2) {
    state_due_ns_ = now_ns + periods_ns(kExtensionPeriods);
    wait_extended_ = true;
    return false;
  }
  expect_state_by(now_ns + periods_ns(kSilentPeriods));
  return begun_ = true;
}

std::int64_t StepTiming::due_ns(bool open) const {
  if (clock_ == runtime::Clock::lockstep || state_due_ns_ == runtime::kNever) return runtime::kNever;
  if (clock_ == runtime::Clock::prescribed) return open ? runtime::kNever : state_due_ns_;
  return state_due_ns_ + (open ? periods_ns(kDemandPeriods) : 0);
}

}  // namespace crane::supervisor
