#include "fastdds/found_endpoints.hpp"

#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <algorithm>

namespace crane::bus::fastdds {
namespace {

namespace rtps = eprosima::fastrtps::rtps;

std::chrono::nanoseconds time(const eprosima::fastrtps::Duration_t& duration) {
  if (duration == eprosima::fastrtps::c_TimeInfinite) return std::chrono::nanoseconds::max();
  return std::chrono::nanoseconds{duration.to_ns()};
}

template <class Qos>
MatchedPolicies policies_of(const Qos& qos) {
  namespace dds = eprosima::fastdds::dds;
  MatchedPolicies found;
  found.reliable = qos.m_reliability.kind == dds::RELIABLE_RELIABILITY_QOS;
  found.durability = static_cast<int>(qos.m_durability.kind);
  found.exclusive = qos.m_ownership.kind == dds::EXCLUSIVE_OWNERSHIP_QOS;
  found.liveliness = static_cast<int>(qos.m_liveliness.kind);
  found.lease = time(qos.m_liveliness.lease_duration);
  found.deadline = time(qos.m_deadline.period);
  for (const auto id : qos.representation.m_value) found.representations.push_back(static_cast<int>(id));
  return found;
}

}  // namespace

template <class Proxy>
void FoundEndpoints::store(const Proxy& proxy, bool writes) {
  Entry entry;
  std::copy_n(std::begin(proxy.guid().guidPrefix.value), rtps::GuidPrefix_t::size, entry.participant.begin());
  entry.endpoint = {writes,
                    proxy.topicName().to_string(),
                    proxy.typeName().to_string(),
                    proxy.m_qos.m_partition.names(),
                    policies_of(proxy.m_qos),
                    {}};
  const std::lock_guard lock{mutex_};
  if (found_.size() < kMost || found_.contains(proxy.guid()))
    found_.insert_or_assign(proxy.guid(), std::move(entry));
}

void FoundEndpoints::forget(const rtps::GUID_t& endpoint) {
  const std::lock_guard lock{mutex_};
  found_.erase(endpoint);
}

void FoundEndpoints::note(const rtps::WriterDiscoveryInfo& found) {
  if (found.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER)
    forget(found.info.guid());
  else
    store(found.info, true);
}

void FoundEndpoints::note(const rtps::ReaderDiscoveryInfo& found) {
  if (found.status == rtps::ReaderDiscoveryInfo::REMOVED_READER)
    forget(found.info.guid());
  else
    store(found.info, false);
}

std::vector<FoundEndpoint> FoundEndpoints::all(
    const std::function<std::string(const ParticipantId&)>& origin_of) const {
  const std::lock_guard lock{mutex_};
  std::vector<FoundEndpoint> all;
  for (const auto& [guid, entry] : found_) {
    all.push_back(entry.endpoint);
    all.back().origin = origin_of(entry.participant);
  }
  return all;
}

}  // namespace crane::bus::fastdds
