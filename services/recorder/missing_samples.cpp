#include "recorder/missing_samples.hpp"

#include <algorithm>
#include <utility>

namespace crane::recorder {
namespace {

/// Subtracts min(a, b) from both numbers. @return min(a, b)
std::uint64_t cancel(std::uint64_t& a, std::uint64_t& b) {
  const auto common = std::min(a, b);
  a -= common;
  b -= common;
  return common;
}

}  // namespace

void MissingSamples::Waiting::add(std::uint64_t more, std::int64_t now_ns) {
  if (samples == 0) first_ns = now_ns;
  samples += more;
  newest_ns = now_ns;
}

bool MissingSamples::Waiting::due(std::int64_t now_ns, bool all) const {
  return samples > 0 && (all || now_ns - first_ns >= kWait_ns);
}

void MissingSamples::gap(std::uint64_t ticks, std::int64_t now_ns) {
  cancel(ticks, awaited_);
  if (ticks > 0) gap_.add(ticks, now_ns);
}

void MissingSamples::report(recording::LossCause cause, std::uint64_t samples, std::int64_t now_ns) {
  auto* const report = std::ranges::find(reports_, cause, &Report::cause);
  if (samples > 0) report->waiting.add(samples, now_ns);
}

void MissingSamples::begin_writer() { awaited_ = noted_ = 0; }

std::vector<MissingSamples::Found> MissingSamples::take(std::int64_t now_ns, bool all) {
  std::vector<Found> found;
  const auto note = [&](recording::LossCause cause, std::uint64_t samples, std::int64_t time_ns) {
    if (samples > 0) found.push_back({cause, samples, time_ns});
  };
  for (auto& [cause, waiting] : reports_) {
    const auto both = cancel(waiting.samples, gap_.samples);
    std::uint64_t alone = 0;
    if (waiting.due(now_ns, all || !every_tick_)) {
      alone = std::exchange(waiting.samples, 0);
      if (cause == recording::LossCause::dds_lost) cancel(alone, noted_);
      if (every_tick_) awaited_ += alone;
    }
    note(cause, both + alone, waiting.newest_ns);
  }
  if (gap_.due(now_ns, all)) {
    const auto ticks = std::exchange(gap_.samples, 0);
    noted_ += ticks;
    note(recording::LossCause::tick_gap, ticks, gap_.newest_ns);
  }
  return found;
}

}  // namespace crane::recorder
