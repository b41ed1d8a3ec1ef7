#pragma once
/// Converts a report of the adaptation to a sample of crane/adaptation.
#include "crane/control/adaptation.hpp"
#include "crane/topics.hpp"

namespace crane::services {

[[nodiscard]] msg::Adaptation adaptation_sample(const msg::Header& header,
                                                const control::AdaptationReport& report) noexcept;

}  // namespace crane::services
