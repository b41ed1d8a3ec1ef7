#pragma once
/// Finds endpoints that cannot exchange samples with the endpoints of the crane.
#include <vector>

#include "crane/bus/found_endpoint.hpp"
#include "doctor/finding.hpp"

namespace crane::doctor {

/// Checks the endpoints of the topics of this project: types, quality of service of each writer against the
/// readers of this project, quality of service of each reader against the found writers.
/// @param endpoints  endpoints found in the crane
[[nodiscard]] Findings judge_endpoints(const std::vector<bus::FoundEndpoint>& endpoints);

}  // namespace crane::doctor
