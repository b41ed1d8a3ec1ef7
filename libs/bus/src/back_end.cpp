#include "back_end.hpp"

#include "crane/bus/cdr.hpp"

namespace crane::bus {

Quality quality(const topics::Description& topic, const EndpointOptions& endpoint) {
  constexpr int kMostInstances = 64;  // a crane has about 10 processes
  Quality q;
  q.instances = CdrCodec::of(*topic.descriptor).has_key() ? kMostInstances : 1;
  q.writer_history = q.reader_history = endpoint.history;
  switch (topic.qos) {
    case topics::Qos::loop:
    case topics::Qos::script:
      q.depth = 128;
      break;
    case topics::Qos::log:
      q.depth = 64;
      q.writer_history = true;
      break;
    case topics::Qos::status:
      q.depth = 1;
      q.writer_history = q.reader_history = true;
      break;
  }
  return q;
}

std::string_view policy_name(int id) {
  switch (id) {
    case 2:
      return "durability";
    case 3:
      return "presentation";
    case 4:
      return "deadline";
    case 5:
      return "latency_budget";
    case 6:
      return "ownership";
    case 8:
      return "liveliness";
    case 10:
      return "partition";
    case 11:
      return "reliability";
    case 12:
      return "destination_order";
    case 13:
      return "history";
    case 14:
      return "resource_limits";
    case 23:
      return "data_representation";
    case 24:
      return "type_consistency";
    default:
      return "unknown";
  }
}

}  // namespace crane::bus
