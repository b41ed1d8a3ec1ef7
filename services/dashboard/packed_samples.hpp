#pragma once
/// Samples as bytes for the page.
#include <string>
#include <vector>

#include "observation/sample.hpp"

namespace crane::dashboard {

/// For every sample: log time (int64), number of bytes (uint32), CDR bytes; little endian.
[[nodiscard]] std::string packed(const std::vector<observation::SamplePtr>& samples);

}  // namespace crane::dashboard
