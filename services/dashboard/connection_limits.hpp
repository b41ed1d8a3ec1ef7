#pragma once
/// Limits the number of connections and the bytes of unread answers. Pure: no sockets.
#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace crane::dashboard {

inline constexpr std::size_t kMostConnections = 64;
/// Largest number of connections from other computers. A flood from other computers therefore leaves
/// connections for the operator at the rig.
inline constexpr std::size_t kMostForeignConnections = 48;
/// Largest number of connections from one address, so that one computer cannot block the others. A browser
/// opens seven.
inline constexpr std::size_t kMostOfOneAddress = 16;
/// Largest number of viewers. Other connections can be displaced (server.hpp); therefore viewers cannot
/// occupy all connections.
inline constexpr std::size_t kMostViewers = 48;
/// Largest number of bytes of answers that clients have not read yet: four times the longest history of a
/// topic.
inline constexpr std::size_t kMostAnswers_bytes = 32U << 20U;

class ConnectionLimits {
 public:
  /// @return false when the connection is refused; it is then not counted
  [[nodiscard]] bool admit(const std::string& address, bool foreign);
  void release(const std::string& address, bool foreign);
  [[nodiscard]] std::size_t open() const { return open_; }

  /// @return false when too many bytes wait; the new bytes are then not counted
  [[nodiscard]] bool reserve(std::size_t bytes);
  void free(std::size_t bytes) { answers_bytes_ -= bytes; }

 private:
  std::size_t open_ = 0, foreign_ = 0, answers_bytes_ = 0;
  std::map<std::string, std::size_t> of_address_;  ///< connections by address; other computers only
};

/// One admitted connection; counts during its lifetime.
class Admission {
 public:
  /// @return null when the connection is refused
  [[nodiscard]] static std::unique_ptr<Admission> ask(std::shared_ptr<ConnectionLimits> limits,
                                                      std::string address, bool foreign);
  ~Admission();
  Admission(const Admission&) = delete;
  Admission& operator=(const Admission&) = delete;

  /// Replaces the reservation. @return false when the answer must not be stored
  [[nodiscard]] bool reserve(std::size_t bytes);

 private:
  Admission(std::shared_ptr<ConnectionLimits> limits, std::string address, bool foreign)
      : limits_{std::move(limits)}, address_{std::move(address)}, foreign_{foreign} {}
  std::shared_ptr<ConnectionLimits> limits_;
  std::string address_;
  bool foreign_;
  std::size_t reserved_bytes_ = 0;
};

}  // namespace crane::dashboard
