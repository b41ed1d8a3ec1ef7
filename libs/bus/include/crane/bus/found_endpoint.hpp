#pragma once
/// Readers and writers of other participants, as discovery announces them, and the reasons why a writer and a
/// reader do not match.
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "crane/topics.hpp"

namespace crane::bus {

/// The policies of DDS that decide whether a writer and a reader match. Numbers as in the DDS standard.
struct MatchedPolicies {
  bool reliable = false;
  int durability = 0;  ///< 0 volatile, 1 transient_local, 2 transient, 3 persistent
  bool exclusive = false;
  int liveliness = 0;  ///< 0 automatic, 1 manual_by_participant, 2 manual_by_topic
  std::chrono::nanoseconds lease = std::chrono::nanoseconds::max();
  std::chrono::nanoseconds deadline = std::chrono::nanoseconds::max();
  /// 0 XCDR1, 1 XML, 2 XCDR2; a writer uses the first, a reader accepts all; empty: XCDR1.
  std::vector<int> representations{};
};

struct FoundEndpoint {
  bool writes = false;
  std::string topic, type;
  std::vector<std::string> partitions{};  ///< names and patterns; empty: the default partition
  MatchedPolicies policies{};
  std::string origin{};  ///< name of the program, process and host as far as known, and GUID prefix
};

/// @return true when the endpoint belongs to the crane: one of its partitions names the crane, or matches it
[[nodiscard]] bool belongs_to(const FoundEndpoint& endpoint, const std::string& crane);

struct PolicyDifference {
  std::string_view policy;
  std::string offered, requested;
};
/// @return the policies for which the writer offers less than the reader requests; empty: both match
[[nodiscard]] std::vector<PolicyDifference> differences(const MatchedPolicies& writer,
                                                        const MatchedPolicies& reader);
/// Policies of the readers of this project, without history and deadline.
[[nodiscard]] MatchedPolicies reader_policies(const topics::Description& topic);

}  // namespace crane::bus
