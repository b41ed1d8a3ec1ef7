#include "cyclone/found_endpoints.hpp"

#include <cstring>
#include <utility>

#include "cyclone/domain.hpp"

namespace crane::bus::cyclone {
namespace {

std::chrono::nanoseconds time(dds_duration_t duration) {
  return duration == DDS_INFINITY ? std::chrono::nanoseconds::max() : std::chrono::nanoseconds{duration};
}

MatchedPolicies policies_of(const dds_qos_t* qos) {
  MatchedPolicies found;
  dds_reliability_kind_t reliability{};
  dds_duration_t unused = 0, lease = DDS_INFINITY, deadline = DDS_INFINITY;
  if (dds_qget_reliability(qos, &reliability, &unused))
    found.reliable = reliability == DDS_RELIABILITY_RELIABLE;
  dds_durability_kind_t durability{};
  if (dds_qget_durability(qos, &durability)) found.durability = static_cast<int>(durability);
  dds_ownership_kind_t ownership{};
  if (dds_qget_ownership(qos, &ownership)) found.exclusive = ownership == DDS_OWNERSHIP_EXCLUSIVE;
  dds_liveliness_kind_t liveliness{};
  if (dds_qget_liveliness(qos, &liveliness, &lease)) {
    found.liveliness = static_cast<int>(liveliness);
    found.lease = time(lease);
  }
  if (dds_qget_deadline(qos, &deadline)) found.deadline = time(deadline);
  std::uint32_t count = 0;
  dds_data_representation_id_t* ids = nullptr;
  if (dds_qget_data_representation(qos, &count, &ids)) {
    found.representations.assign(ids, ids + count);
    dds_free(ids);
  }
  return found;
}

std::vector<std::string> partitions_of(const dds_qos_t* qos) {
  std::vector<std::string> names;
  std::uint32_t count = 0;
  char** found = nullptr;
  if (!dds_qget_partition(qos, &count, &found)) return names;
  for (std::uint32_t i = 0; i < count; ++i) {
    names.emplace_back(found[i]);
    dds_free(found[i]);
  }
  dds_free(found);
  return names;
}

}  // namespace

std::vector<FoundEndpoint> found_endpoints(
    dds_entity_t own_participant, const std::function<std::string(const ParticipantId&)>& origin_of) {
  std::vector<FoundEndpoint> all;
  dds_guid_t own{};
  dds_get_guid(own_participant, &own);
  for (const auto& [topic, writes] : {std::pair{DDS_BUILTIN_TOPIC_DCPSPUBLICATION, true},
                                      std::pair{DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, false}}) {
    const auto reader = checked_entity(dds_create_reader(own_participant, topic, nullptr, nullptr),
                                       "cannot read the endpoints of the domain");
    for (;;) {
      void* sample[1] = {nullptr};
      dds_sample_info_t info{};
      if (dds_take(reader, sample, &info, 1, 1) != 1) break;
      const auto* endpoint = static_cast<const dds_builtintopic_endpoint_t*>(sample[0]);
      const bool is_own = std::memcmp(&endpoint->participant_key, &own, sizeof own) == 0;
      if (info.valid_data && info.instance_state == DDS_IST_ALIVE && !is_own) {
        ParticipantId participant{};
        std::memcpy(participant.data(), endpoint->participant_key.v, participant.size());
        all.push_back({writes, endpoint->topic_name, endpoint->type_name, partitions_of(endpoint->qos),
                       policies_of(endpoint->qos), origin_of(participant)});
      }
      dds_return_loan(reader, sample, 1);
    }
    dds_delete(reader);
  }
  return all;
}

}  // namespace crane::bus::cyclone
