#include "crane/bus/found_endpoint.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <array>

#include "back_end.hpp"

namespace crane::bus {
namespace {

template <std::size_t N>
std::string name_in(const std::array<const char*, N>& names, int number) {
  return number >= 0 && static_cast<std::size_t>(number) < N ? names[static_cast<std::size_t>(number)]
                                                             : std::to_string(number);
}
constexpr std::array kDurabilities{"volatile", "transient_local", "transient", "persistent"};
constexpr std::array kLivelinesses{"automatic", "manual_by_participant", "manual_by_topic"};
constexpr std::array kRepresentations{"XCDR1", "XML", "XCDR2"};

std::string reliability(bool reliable) { return reliable ? "reliable" : "best_effort"; }
std::string ownership(bool exclusive) { return exclusive ? "exclusive" : "shared"; }
std::string time(std::chrono::nanoseconds time) {
  if (time == std::chrono::nanoseconds::max()) return "infinite";
  return std::to_string(std::chrono::duration_cast<std::chrono::microseconds>(time).count()) + " us";
}

std::vector<int> representations(const MatchedPolicies& policies) {
  return policies.representations.empty() ? std::vector{0} : policies.representations;
}
std::string in_words(const std::vector<int>& representations) {
  std::string text;
  for (const int one : representations) text += (text.empty() ? "" : " or ") + name_in(kRepresentations, one);
  return text;
}

}  // namespace

bool belongs_to(const FoundEndpoint& endpoint, const std::string& crane) {
  return std::ranges::any_of(endpoint.partitions, [&](const std::string& partition) {
    return partition == crane || ::fnmatch(partition.c_str(), crane.c_str(), 0) == 0;
  });
}

std::vector<PolicyDifference> differences(const MatchedPolicies& writer, const MatchedPolicies& reader) {
  std::vector<PolicyDifference> found;
  const auto compare = [&](bool offers_enough, const char* policy, std::string offered,
                           std::string requested) {
    if (!offers_enough) found.push_back({policy, std::move(offered), std::move(requested)});
  };
  compare(writer.reliable || !reader.reliable, "reliability", reliability(writer.reliable),
          reliability(reader.reliable));
  compare(writer.durability >= reader.durability, "durability", name_in(kDurabilities, writer.durability),
          name_in(kDurabilities, reader.durability));
  compare(writer.exclusive == reader.exclusive, "ownership", ownership(writer.exclusive),
          ownership(reader.exclusive));
  compare(writer.deadline <= reader.deadline, "deadline", time(writer.deadline), time(reader.deadline));
  compare(writer.liveliness >= reader.liveliness, "liveliness", name_in(kLivelinesses, writer.liveliness),
          name_in(kLivelinesses, reader.liveliness));
  compare(writer.lease <= reader.lease, "liveliness lease", time(writer.lease), time(reader.lease));
  const auto accepted = representations(reader);
  const int used = representations(writer).front();
  compare(std::ranges::find(accepted, used) != accepted.end(), "data representation",
          name_in(kRepresentations, used), in_words(accepted));
  return found;
}

MatchedPolicies reader_policies(const topics::Description& topic) {
  MatchedPolicies policies;
  policies.reliable = true;
  policies.durability = quality(topic, {}).reader_history ? 1 : 0;
  return policies;
}

}  // namespace crane::bus
