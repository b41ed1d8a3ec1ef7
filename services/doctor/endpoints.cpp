#include "doctor/endpoints.hpp"

#include <algorithm>
#include <set>
#include <string>

namespace crane::doctor {
namespace {

using bus::FoundEndpoint;

std::string subject(const FoundEndpoint& endpoint) {
  return std::string{endpoint.writes ? "a writer" : "a reader"} + " of " + endpoint.topic + " (" +
         endpoint.origin + ")";
}

Finding wrong_type(const FoundEndpoint& endpoint, const topics::Description& topic) {
  return {Grade::problem, "net", "type_mismatch",
          subject(endpoint) + " has the type " + endpoint.type + ", the crane has " +
              std::string{topic.type} + ": no sample is exchanged",
          "generate the types of that program from crane.idl, or give its topic another name"};
}

Finding wrong_quality(const FoundEndpoint& endpoint, const bus::PolicyDifference& difference) {
  const std::string policy{difference.policy};
  if (endpoint.writes)
    return {Grade::problem, "net", "quality_of_service",
            subject(endpoint) + " offers " + policy + " " + difference.offered +
                ", the readers of the crane request " + difference.requested + ": its samples do not arrive",
            "set " + policy + " " + difference.requested + " in that program, or end it"};
  return {Grade::problem, "net", "quality_of_service",
          subject(endpoint) + " requests " + policy + " " + difference.requested +
              ", the writer of the crane offers " + difference.offered + ": it receives no sample",
          "set " + policy + " " + difference.offered + " in that program, or end it"};
}

}  // namespace

Findings judge_endpoints(const std::vector<FoundEndpoint>& endpoints) {
  Findings findings;
  std::set<std::string> reported;  // one finding, although a reader can differ from several writers equally
  const auto report = [&](Finding finding) {
    if (reported.insert(finding.what).second) findings.push_back(std::move(finding));
  };
  for (const auto& one : endpoints) {
    const auto* const topic = std::ranges::find(topics::kAll, one.topic, &topics::Description::name);
    if (topic == topics::kAll.end()) continue;
    if (one.type != topic->type) {
      report(wrong_type(one, *topic));
    } else if (one.writes) {
      for (const auto& found : bus::differences(one.policies, bus::reader_policies(*topic)))
        report(wrong_quality(one, found));
    } else {
      for (const auto& writer : endpoints) {
        // A writer with another quality of service has its own finding.
        const bool is_of_crane = writer.writes && writer.topic == one.topic && writer.type == one.type &&
                                 bus::differences(writer.policies, bus::reader_policies(*topic)).empty();
        if (!is_of_crane) continue;
        for (const auto& found : bus::differences(writer.policies, one.policies))
          report(wrong_quality(one, found));
      }
    }
  }
  return findings;
}

}  // namespace crane::doctor
