#pragma once
/// Limits the number of connections and the bytes of unread answers, and shares the connections between the
/// clients. No sockets and no clock.
#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace crane::dashboard {

/// Largest number of connections of other computers together, and of this computer. Foreign connections thus
/// cannot exclude local ones, and vice versa. A browser opens seven connections.
inline constexpr std::size_t kMostOfOneSide = 48;
inline constexpr std::size_t kMostConnections = 2 * kMostOfOneSide;
/// Largest number of viewers of one side. The remaining connections of this side can always be displaced
/// (server.hpp).
inline constexpr std::size_t kMostViewers = 32;
/// Largest number of bytes of long answers that clients have not read yet: four times the longest history of
/// a topic.
inline constexpr std::size_t kMostAnswers_bytes = 32U << 20U;
/// A shorter answer is always permitted, so that an operator receives answers while other clients do not read
/// theirs. The number of connections bounds the sum of these answers to 6 MB.
inline constexpr std::size_t kShortAnswer_bytes = 64U << 10U;

/// Unit of the fair share of connections: another computer, or one user of this computer.
struct Client {
  bool foreign = false;  ///< true: on another computer
  std::string name;      ///< IPv4 address, network of an IPv6 address (64 bits), or user
  auto operator<=>(const Client&) const = default;
};

enum class Kind { connection, viewer };  ///< each viewer is also a connection

class ConnectionLimits {
 public:
  /// @return true when the side of the client has a free place
  [[nodiscard]] bool has_place(const Client& client, Kind kind) const;
  [[nodiscard]] std::size_t open(const Client& client, Kind kind) const;
  [[nodiscard]] std::size_t open() const;
  /// @return true when `to` may take a place from `holder`: both are on the same side, and the holder has
  /// more. With n clients on one side, each keeps at least 48/n connections: its newest ones.
  [[nodiscard]] bool must_yield(const Client& holder, const Client& to, Kind kind) const;

  void add(const Client& client, Kind kind) { ++open_[client].of(kind); }
  void remove(const Client& client, Kind kind);

  /// Counts `bytes` of an unread answer. @return false, without counting, when too many bytes wait
  [[nodiscard]] bool reserve(std::size_t bytes);
  void free(std::size_t bytes) { answers_bytes_ -= bytes; }
  /// @return true when reserve(bytes) would succeed
  [[nodiscard]] bool has_room(std::size_t bytes) const {
    return answers_bytes_ + bytes <= kMostAnswers_bytes;
  }

 private:
  struct Count {
    std::size_t connections = 0, viewers = 0;
    std::size_t& of(Kind kind) { return kind == Kind::viewer ? viewers : connections; }
    [[nodiscard]] std::size_t of(Kind kind) const { return kind == Kind::viewer ? viewers : connections; }
  };
  std::size_t answers_bytes_ = 0;
  std::map<Client, Count> open_;
};

/// One admitted connection; counts during its lifetime.
class Admission {
 public:
  Admission(std::shared_ptr<ConnectionLimits> limits, Client client);
  ~Admission();
  Admission(const Admission&) = delete;
  Admission& operator=(const Admission&) = delete;

  [[nodiscard]] const Client& client() const { return client_; }
  /// The connection becomes a viewer.
  void become_viewer();
  /// Replaces the reservation of the previous answer. @return false when the new answer must not be stored
  [[nodiscard]] bool reserve(std::size_t bytes);

 private:
  std::shared_ptr<ConnectionLimits> limits_;
  Client client_;
  bool viewer_ = false;
  std::size_t reserved_bytes_ = 0;
};

}  // namespace crane::dashboard
