#pragma once
/// The protocol foxglove.websocket.v1 of viewers (Foxglove, Lichtblick, PlotJuggler) and of the dashboard's
/// own page. No sockets: texts and bytes only.
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "dashboard/send_queue.hpp"

namespace crane::dashboard {

/// Sub-protocols of the WebSocket. The sub-protocol of the page puts many messages into one frame, because
/// a thousand frames per second would cost browser and dashboard more time than their samples.
inline constexpr std::string_view kViewerProtocol = "foxglove.websocket.v1";
inline constexpr std::string_view kPageProtocol = "crane.batch.v1";

/// A channel is a topic of the bus (CDR, schema in IDL), or a document of the dashboard (JSON).
struct Channel {
  std::uint32_t id = 0;
  std::string topic, encoding, schema_name, schema, schema_encoding;
};
/// Documents of the dashboard; their channels follow those of the topics.
enum class Document : std::uint8_t { situation, traffic, faults, seat };
inline constexpr std::size_t kDocuments = 4;
[[nodiscard]] std::uint32_t channel_of(Document document);
[[nodiscard]] std::uint32_t channel_of_topic(std::size_t topic);
[[nodiscard]] const std::vector<Channel>& channels();

[[nodiscard]] std::string server_info(const std::string& name, const std::string& session);
[[nodiscard]] std::string advertise();
[[nodiscard]] std::string status_message(const std::string& what);

// Messages of a client.
struct Subscribe {
  struct Entry {
    std::uint32_t id = 0, channel = 0;
  };
  std::vector<Entry> entries;
};
struct Unsubscribe {
  std::vector<std::uint32_t> ids;
};
struct GetParameters {
  std::vector<std::string> names;  ///< empty: all
  std::string id;
};
struct Ignored {};  ///< a permitted message without effect, for example subscribeParameterUpdates
using ClientMessage = std::variant<Subscribe, Unsubscribe, GetParameters, Ignored>;

/// what() is sent to the client.
class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
inline constexpr std::size_t kLongestMessage_bytes = 65536;
inline constexpr std::size_t kMostSubscriptions = 64;
/// @throws ProtocolError when the text or the bytes are not a message of a client
[[nodiscard]] ClientMessage parse_client_message(std::string_view text);

template <class T>
void append_little_endian(std::string& out, T value) {
  static_assert(std::is_unsigned_v<T>);
  for (std::size_t i = 0; i < sizeof(T); ++i) out += static_cast<char>(value >> (8 * i) & 0xFFU);
}
/// Head of a "message data" frame; the payload follows.
[[nodiscard]] std::string message_head(std::uint32_t subscription, std::int64_t time_ns);
[[nodiscard]] std::string time_message(std::int64_t time_ns);

/// One frame of kPageProtocol with many messages, each as kind (1 text, 2 data), length (uint32) and bytes.
/// Takes messages from `queue` until it is empty or the frame is full.
[[nodiscard]] std::string batch_of(SendQueue& queue);

}  // namespace crane::dashboard
