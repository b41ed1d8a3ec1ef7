#pragma once
/// Samples as bytes for the page.
#include <string>
#include <vector>

#include "observation/sample.hpp"

namespace crane::dashboard {

/// Of every sample the log time (int64), the number of bytes (uint32) and the CDR bytes, all little endian.
[[nodiscard]] std::string packed(const std::vector<observation::SamplePtr>& samples);

}  // namespace crane::dashboard
