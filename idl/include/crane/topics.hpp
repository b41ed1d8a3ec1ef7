#pragma once
/// The topic set: one line per topic. Everything that has to know all topics (bus, recorder, `crane topic`)
/// walks this list; nothing else has to be touched when a topic is added.
#include <array>
#include <cstdint>
#include <string_view>

#include "crane.h"  // generated from crane.idl by idlc

namespace crane::msg {
using Header = crane_Header;
using State = crane_CraneState;
using AxisReference = crane_AxisReference;
using Reference = crane_Reference;
using Contribution = crane_Contribution;
using Demand = crane_Demand;
using Command = crane_Command;
using SupervisorStatus = crane_SupervisorStatus;
using Request = crane_Request;
using Reply = crane_Reply;
using NodeStatus = crane_NodeStatus;
using Event = crane_Event;
using AcceptedMove = crane_AcceptedMove;
using Twin = crane_Twin;
}  // namespace crane::msg

namespace crane::topics {

/// Quality of service by purpose. The back ends translate it; see libs/bus.
enum class Qos : std::uint8_t {
  loop,    ///< every tick: reliable, history long enough for a lockstep run's chunk
  script,  ///< requests and replies: reliable, nothing dropped that an operator typed
  status,  ///< last value per instance, also for a late joiner
  log      ///< events: the last ones also for a late joiner
};

/// A set of crane_Source values, one bit each.
using Sources = std::uint32_t;
template <class... Source>
[[nodiscard]] constexpr Sources only(Source... source) {
  return ((Sources{1} << static_cast<unsigned>(source)) | ...);
}
/// Processes that run and report on themselves; a tool that asks or reads does not.
inline constexpr Sources kProcesses =
    only(crane_SOURCE_PLANT, crane_SOURCE_BRIDGE, crane_SOURCE_PLANNER, crane_SOURCE_TRACKING,
         crane_SOURCE_ANTI_SWING, crane_SOURCE_FRICTION, crane_SOURCE_SUPERVISOR, crane_SOURCE_RECORDER,
         crane_SOURCE_TWIN);

/// A topic without its C++ type.
struct Description {
  std::string_view name;                     ///< "crane/state"
  std::string_view type;                     ///< IDL name "crane::CraneState"
  const dds_topic_descriptor_t* descriptor;  ///< made by idlc
  Qos qos;
  bool every_tick;  ///< loop topic: one writer at a time, one sample per tick, joined by tick number
  Sources writers;  ///< kinds of process that may write it
};
[[nodiscard]] inline bool may_write(const Description& topic, crane_Source source) {
  return static_cast<unsigned>(source) < 32 && (topic.writers & only(source)) != 0;
}

/// A topic with its C++ type: `bus.subscriber(topics::state)`.
template <class T>
struct Topic {
  Description description;
};

// variable, IDL type, name, quality of service, every tick, writers
#define CRANE_TOPICS(X)                                                                          \
  X(state, CraneState, "crane/state", loop, true, only(crane_SOURCE_PLANT, crane_SOURCE_BRIDGE)) \
  X(reference, Reference, "crane/reference", loop, true, only(crane_SOURCE_PLANNER))             \
  X(tracking, Contribution, "crane/tracking", loop, true, only(crane_SOURCE_TRACKING))           \
  X(anti_swing, Contribution, "crane/anti_swing", loop, true, only(crane_SOURCE_ANTI_SWING))     \
  X(demand, Demand, "crane/demand", loop, true, only(crane_SOURCE_FRICTION))                     \
  X(command, Command, "crane/command", loop, true, only(crane_SOURCE_SUPERVISOR))                \
  X(supervisor, SupervisorStatus, "crane/supervisor", loop, true, only(crane_SOURCE_SUPERVISOR)) \
  X(request, Request, "crane/request", script, false, only(crane_SOURCE_OPERATOR))               \
  X(reply, Reply, "crane/reply", script, false,                                                  \
    only(crane_SOURCE_SUPERVISOR, crane_SOURCE_PLANT, crane_SOURCE_BRIDGE))                      \
  X(node, NodeStatus, "crane/node", status, false, kProcesses)                                   \
  X(event, Event, "crane/event", log, false, kProcesses)                                         \
  X(twin, Twin, "crane/twin", loop, true, only(crane_SOURCE_TWIN))

#define CRANE_DECLARE_TOPIC(variable, type, name, qos, every_tick, writers) \
  inline const Topic<crane_##type> variable{                                \
      Description{name, "crane::" #type, &crane_##type##_desc, Qos::qos, every_tick, writers}};
CRANE_TOPICS(CRANE_DECLARE_TOPIC)
#undef CRANE_DECLARE_TOPIC

#define CRANE_LIST_TOPIC(variable, type, name, qos, every_tick, writers) variable.description,
/// All topics, in the order in which one tick writes them.
inline const std::array kAll{CRANE_TOPICS(CRANE_LIST_TOPIC)};
#undef CRANE_LIST_TOPIC

/// Text of crane.idl: schema of recordings, names of fields.
std::string_view idl_text();

}  // namespace crane::topics
