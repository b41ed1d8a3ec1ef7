#include "crane/configuration/realtime_period.hpp"
#include "crane/fields/shortest.hpp"

#include "section_reader.hpp"

namespace crane::configuration {

void require_realtime_period(const Rig& rig) {
  // A period of exactly 1 ms in the rig file reads as the same number.
  if (rig.period_s >= kShortestRealtimePeriod_s) return;
  throw ConfigurationError({rig.path + ": period_s = " + fields::shortest(rig.period_s) +
                            ": must be at least " + fields::shortest(kShortestRealtimePeriod_s) +
                            " in real time (1 kHz); shorter periods are possible in lockstep"});
}

}  // namespace crane::configuration
