#pragma once
/// How many connections, and how many bytes of answers, clients may hold at a time. Pure: no sockets.
#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace crane::dashboard {

inline constexpr std::size_t kMostConnections = 64;
/// Of them for other computers, so that a flood from there leaves room for the operator at the rig.
inline constexpr std::size_t kMostForeignConnections = 48;
/// Of them for one address: one computer does not shut out the others. A browser opens seven.
inline constexpr std::size_t kMostOfOneAddress = 16;
/// Answers that clients have asked for and not read yet: four times the longest history of a topic.
inline constexpr std::size_t kMostAnswers_bytes = 32U << 20U;

class ConnectionLimits {
 public:
  /// @return false: the connection is refused, and nothing is counted
  [[nodiscard]] bool admit(const std::string& address, bool foreign);
  void release(const std::string& address, bool foreign);
  [[nodiscard]] std::size_t open() const { return open_; }

  /// @return false: too much is waiting, and nothing is counted
  [[nodiscard]] bool reserve(std::size_t bytes);
  void free(std::size_t bytes) { answers_bytes_ -= bytes; }

 private:
  std::size_t open_ = 0, foreign_ = 0, answers_bytes_ = 0;
  std::map<std::string, std::size_t> of_address_;  ///< of other computers only
};

/// One admitted connection: counts as long as it lives.
class Admission {
 public:
  /// @return null when the connection is refused
  [[nodiscard]] static std::unique_ptr<Admission> ask(std::shared_ptr<ConnectionLimits> limits,
                                                      std::string address, bool foreign);
  ~Admission();
  Admission(const Admission&) = delete;
  Admission& operator=(const Admission&) = delete;

  /// Replaces what was reserved before. @return false: the answer must not be kept
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
