#pragma once
/// crane/adaptation from the report of the adaptation.
#include "crane/control/adaptation.hpp"
#include "crane/topics.hpp"

namespace crane::services {

[[nodiscard]] msg::Adaptation adaptation_sample(const msg::Header& header,
                                                const control::AdaptationReport& report) noexcept;

}  // namespace crane::services
