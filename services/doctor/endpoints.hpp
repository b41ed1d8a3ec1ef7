#pragma once
/// Endpoints that cannot exchange samples with those of the crane.
#include <vector>

#include "crane/bus/found_endpoint.hpp"
#include "doctor/finding.hpp"

namespace crane::doctor {

/// Checks the endpoints that have the name of a topic of this project: the type of each, the quality of
/// service of a writer against the readers of this project, and that of a reader against the writers that
/// were found.
/// @param endpoints  of the crane
[[nodiscard]] Findings judge_endpoints(const std::vector<bus::FoundEndpoint>& endpoints);

}  // namespace crane::doctor
