#include "dashboard/foxglove.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "crane/topics.hpp"

namespace crane::dashboard {
namespace {

using nlohmann::json;

constexpr std::array<const char*, kDocuments> kDocumentNames{"dashboard/situation", "dashboard/traffic",
                                                             "dashboard/faults", "dashboard/operator"};

std::vector<Channel> make_channels() {
  std::vector<Channel> all;
  all.reserve(topics::kAll.size() + kDocuments);
  for (const auto& topic : topics::kAll)
    all.push_back({channel_of_topic(all.size()), "/" + std::string{topic.name}, "cdr",
                   std::string{topic.type}, std::string{topics::idl_text()}, "omgidl"});
  for (std::size_t i = 0; i < kDocuments; ++i)
    all.push_back({channel_of(static_cast<Document>(i)), std::string{"/"} + kDocumentNames[i], "json",
                   kDocumentNames[i], R"({"type":"object"})", "jsonschema"});
  return all;
}

std::uint32_t number_of(const json& value, const char* what) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > 0xFFFFFFFFU)
    throw ProtocolError(std::string{what} + " must be a number from 0 to 4294967295");
  return value.get<std::uint32_t>();
}

const json& list_of(const json& message, const char* key) {
  const auto found = message.find(key);
  if (found == message.end() || !found->is_array())
    throw ProtocolError(std::string{key} + ": a list is expected");
  if (found->size() > kMostSubscriptions) throw ProtocolError(std::string{key} + ": more than 64 entries");
  return *found;
}

Subscribe subscribe_of(const json& message) {
  Subscribe result;
  for (const auto& entry : list_of(message, "subscriptions")) {
    if (!entry.is_object()) throw ProtocolError("subscriptions: objects are expected");
    result.entries.push_back({number_of(entry.value("id", json{}), "id"),
                              number_of(entry.value("channelId", json{}), "channelId")});
    const auto channel = result.entries.back().channel;
    if (channel == 0 || channel > channels().size())
      throw ProtocolError("no channel has the number " + std::to_string(channel));
  }
  return result;
}

GetParameters parameters_of(const json& message) {
  GetParameters result;
  for (const auto& name : list_of(message, "parameterNames"))
    if (name.is_string()) result.names.push_back(name.get<std::string>());
  if (const auto id = message.find("id"); id != message.end() && id->is_string())
    result.id = id->get<std::string>();
  return result;
}

}  // namespace

std::uint32_t channel_of_topic(std::size_t topic) { return static_cast<std::uint32_t>(topic + 1); }
std::uint32_t channel_of(Document document) {
  return channel_of_topic(topics::kAll.size() + static_cast<std::size_t>(document));
}
const std::vector<Channel>& channels() {
  static const auto all = make_channels();
  return all;
}

std::string server_info(const std::string& name, const std::string& session) {
  return json{{"op", "serverInfo"},
              {"name", name},
              {"capabilities", {"time", "parameters"}},
              {"supportedEncodings", json::array()},
              {"metadata", {{"program", "crane_dashboard"}}},
              {"sessionId", session}}
      .dump();
}

std::string advertise() {
  auto list = json::array();
  for (const auto& channel : channels())
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", channel.encoding},
                    {"schemaName", channel.schema_name},
                    {"schema", channel.schema},
                    {"schemaEncoding", channel.schema_encoding}});
  return json{{"op", "advertise"}, {"channels", list}}.dump();
}

std::string status_message(const std::string& what) {
  constexpr int kError = 2;
  return json{{"op", "status"}, {"level", kError}, {"message", what}}.dump(-1, ' ', false,
                                                                           json::error_handler_t::replace);
}

ClientMessage parse_client_message(std::string_view text) {
  if (text.size() > kLongestMessage_bytes) throw ProtocolError("the message is longer than 65536 bytes");
  // Deeply nested lists would overflow the stack of a recursive reader. Valid messages have at most four
  // levels.
  constexpr int kDeepest = 6;
  const auto message = json::parse(
      text,
      [](int depth, json::parse_event_t, json&) {
        if (depth > kDeepest) throw ProtocolError("the message is nested too deeply");
        return true;
      },
      false);
  if (!message.is_object()) throw ProtocolError("a JSON object is expected");
  const auto found = message.find("op");
  if (found == message.end() || !found->is_string()) throw ProtocolError("the message has no op");
  const auto op = found->get<std::string>();
  if (op == "subscribe") return subscribe_of(message);
  if (op == "getParameters") return parameters_of(message);
  if (op == "unsubscribe") {
    Unsubscribe result;
    for (const auto& id : list_of(message, "subscriptionIds"))
      result.ids.push_back(number_of(id, "subscriptionIds"));
    return result;
  }
  if (op == "subscribeParameterUpdates" || op == "unsubscribeParameterUpdates") return Ignored{};
  throw ProtocolError("op " + op.substr(0, 64) +
                      " is not supported: the dashboard publishes, and is operated through /api/request");
}

std::string message_head(std::uint32_t subscription, std::int64_t time_ns) {
  constexpr char kMessageData = 1;
  std::string head{kMessageData};
  append_little_endian(head, subscription);
  append_little_endian(head, static_cast<std::uint64_t>(time_ns));
  return head;
}

std::string time_message(std::int64_t time_ns) {
  constexpr char kTime = 2;
  std::string message{kTime};
  append_little_endian(message, static_cast<std::uint64_t>(time_ns));
  return message;
}

std::string batch_of(SendQueue& queue) {
  constexpr std::size_t kFull_bytes = 256U << 10U;
  std::string frame;
  while (!queue.empty() && frame.size() < kFull_bytes) {
    const auto message = queue.take();
    frame += message.binary ? '\2' : '\1';
    append_little_endian(frame, static_cast<std::uint32_t>(message.bytes()));
    frame += message.head;
    if (message.payload) frame.append(message.payload->begin(), message.payload->end());
  }
  return frame;
}

}  // namespace crane::dashboard
