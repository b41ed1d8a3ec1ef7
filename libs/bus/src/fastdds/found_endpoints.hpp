#pragma once
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <functional>
#include <map>
#include <mutex>
#include <vector>

#include "crane/bus/bus.hpp"

namespace crane::bus::fastdds {

/// The endpoints that discovery has announced. Thread-safe.
class FoundEndpoints {
 public:
  void note(const eprosima::fastrtps::rtps::WriterDiscoveryInfo& found);
  void note(const eprosima::fastrtps::rtps::ReaderDiscoveryInfo& found);
  /// @param origin_of  of a participant
  [[nodiscard]] std::vector<FoundEndpoint> all(
      const std::function<std::string(const ParticipantId&)>& origin_of) const;

 private:
  struct Entry {
    ParticipantId participant{};
    FoundEndpoint endpoint;
  };
  template <class Proxy>
  void store(const Proxy& proxy, bool writes);
  void forget(const eprosima::fastrtps::rtps::GUID_t& endpoint);

  static constexpr std::size_t kMost = 4096;  ///< bounds the memory that other programs can use
  mutable std::mutex mutex_;
  std::map<eprosima::fastrtps::rtps::GUID_t, Entry> found_;
};

}  // namespace crane::bus::fastdds
