#include "crane/identification/validation.hpp"

#include <algorithm>
#include <cmath>

#include "crane/control/filters.hpp"

namespace crane::identification {

std::vector<double> linear_response(const LinearLoop& loop, std::span<const double> reference, double start) {
  const control::FilterSection low_pass = control::butterworth_low_pass(loop.cutoff_ratio);
  const control::FilterSection differentiator = control::al_alaoui_second_order(1 / loop.period_s);
  control::FilterMemory low_pass_memory = control::settled(low_pass, start);
  control::FilterMemory differentiator_memory = control::settled(differentiator, start);
  std::vector<double> positions;
  positions.reserve(reference.size());
  double position = start, speed = 0, acting_v = 0;
  for (const double wanted : reference) {
    positions.push_back(position);
    const double measured_speed = control::step(differentiator, differentiator_memory,
                                                control::step(low_pass, low_pass_memory, position));
    const double acceleration = loop.gain * acting_v;
    acting_v = loop.stiffness_vpu * (wanted - position) - loop.damping_vspu * measured_speed;
    position += (speed + acceleration * loop.period_s / 2) * loop.period_s;
    speed += acceleration * loop.period_s;
  }
  return positions;
}

Deviation deviation(std::span<const double> measured, std::span<const double> model) {
  Deviation result;
  double squares = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const double difference = measured[i] - model[i];
    squares += difference * difference;
    result.peak = std::max(result.peak, std::abs(difference));
  }
  if (!measured.empty()) result.rms = std::sqrt(squares / static_cast<double>(measured.size()));
  return result;
}

}  // namespace crane::identification
