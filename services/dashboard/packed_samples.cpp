#include "dashboard/packed_samples.hpp"

#include "dashboard/foxglove.hpp"

namespace crane::dashboard {

std::string packed(const std::vector<observation::SamplePtr>& samples) {
  std::string out;
  for (const auto& sample : samples) {
    append_little_endian(out, static_cast<std::uint64_t>(sample->log_time_ns));
    append_little_endian(out, static_cast<std::uint32_t>(sample->cdr.size()));
    out.append(sample->cdr.begin(), sample->cdr.end());
  }
  return out;
}

}  // namespace crane::dashboard
