#include "process/sole_reader.hpp"

#include <stdexcept>

#include "crane/protection.hpp"

namespace crane::supervisor {

void SoleReader::take(std::int64_t now_ns) {
  constexpr int kMostPerPoll = 64;
  bus::SampleInfo info;
  const bool watches = realtime_ && protection::enabled(protection::Protection::supervisor_sole);
  for (int taken = 0; taken < kMostPerPoll; ++taken) {
    const auto status = supervisors_.take(&info);
    if (!status) break;
    if (info.valid && watches) sole_.heard(*status, info.writer, now_ns);
  }
  for (int taken = 0; taken < kMostPerPoll; ++taken) {
    const auto status = nodes_.take(&info);
    if (!status) break;
    if (info.valid && watches) sole_.heard(*status);
  }
  if (sole_.yields()) yield();
  const bool disputed = sole_.disputed(now_ns);
  if (disputed && !reported_)
    node_.error("second_supervisor",
                "another supervisor of this crane runs: " + sole_.rival() + "; both refuse reset and arming",
                "end one of the two, or start one with another --crane or --domain, then `crane reset`");
  reported_ = disputed;
}

void SoleReader::yield() {
  const std::string what =
      "another supervisor of this crane runs: " + sole_.rival() + "; this supervisor exits";
  constexpr const char* kRemedy =
      "if the other supervisor belongs to another crane, start one of them with another --crane or --domain";
  node_.error("second_supervisor", what, kRemedy);
  throw std::runtime_error(what + "; " + kRemedy);
}

}  // namespace crane::supervisor
