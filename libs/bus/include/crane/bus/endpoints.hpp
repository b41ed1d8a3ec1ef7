#pragma once
/// Publishers and subscribers of one topic. crane/bus/bus.hpp creates them.
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "crane/topics.hpp"

namespace crane::bus {

/// Identifies the DDS writer of a sample: equal for all samples of one writer, different for any two writers.
/// Valid within this process. Any sender can copy a Header. Without keys, a sender can also copy the GUID of
/// a writer by choosing its GUID prefix or by forging RTPS packets (docs/security.md).
using WriterId = std::array<std::uint8_t, 16>;

/// Identifies the DDS participant of a writer. Equal for all writers of a participant (a Bus and
/// its shares, Bus::share), different for any two participants. Over DDS: the GUID prefix.
using ParticipantId = std::array<std::uint8_t, 12>;
/// The writer has ended before its sample was taken: its participant cannot be determined.
inline constexpr ParticipantId kUnknownParticipant{};

struct SampleInfo {
  std::int64_t source_time_ns = 0;  ///< clock of the writer; memory: Header.sample_time_ns
  bool valid = false;               ///< false: the sample has no data, only the state of its instance changed
  bool disposed = false;            ///< true: the writer disposed the instance
  /// false: a sample of a loop topic that is not in the ledger of this bus (crane/bus/ledger.hpp). Without a
  /// ledger always true.
  bool entered = true;
  WriterId writer{};
  ParticipantId participant = kUnknownParticipant;
};

/// Counts since the creation of the reader.
struct ReaderCounts {
  std::uint64_t taken = 0;     ///< intact samples that take() returned
  std::uint64_t rejected = 0;  ///< samples dropped for a wrong CRC
};

/// Part of a publisher that does not depend on the type of its samples.
class UntypedPublisher {
 public:
  struct State;  ///< internal to the library
  explicit UntypedPublisher(std::unique_ptr<State> state);
  ~UntypedPublisher();
  UntypedPublisher(UntypedPublisher&&) noexcept;
  UntypedPublisher& operator=(UntypedPublisher&&) noexcept;

  [[nodiscard]] bool assert_liveliness();
  /// Waits until all matched readers have acknowledged all samples of this publisher and can take them. A
  /// reader that discovers this publisher later acknowledges earlier samples without receiving them.
  /// @return false when a reader has not acknowledged within `timeout`
  [[nodiscard]] bool wait_until_acknowledged(std::chrono::nanoseconds timeout);
  /// Number of matched readers.
  [[nodiscard]] int matched() const;

 protected:
  [[nodiscard]] bool send(void* sample);
  [[nodiscard]] bool dispose_of(const void* sample);

 private:
  std::unique_ptr<State> state_;
};

template <class T>
class Publisher : public UntypedPublisher {
  static_assert(std::is_trivially_copyable_v<T>, "topics have fixed-size fields and bounded strings only");

 public:
  explicit Publisher(UntypedPublisher&& untyped) : UntypedPublisher{std::move(untyped)} {}
  /// Sets source, epoch and CRC of `sample` and sends it. @return false when the middleware did not send it
  [[nodiscard]] bool publish(T sample) { return send(&sample); }
  [[nodiscard]] bool dispose(const T& sample) { return dispose_of(&sample); }
};

/// Writer of any topic, for tools. It publishes the plain-CDR bytes that recordings store.
class CdrPublisher : public UntypedPublisher {
 public:
  CdrPublisher(const topics::Description& topic, UntypedPublisher&& untyped);
  /// Sets source, epoch and CRC of the sample and sends it. @param cdr  little endian, with the 4-byte
  /// encapsulation header
  /// @return false when `cdr` is not a sample of the topic, or when the middleware did not send it
  [[nodiscard]] bool publish(std::span<const std::uint8_t> cdr);
  [[nodiscard]] const topics::Description& topic() const { return *topic_; }

 private:
  const topics::Description* topic_;
  std::vector<std::uint8_t> sample_;
};

/// Part of a subscriber that does not depend on the type of its samples.
class UntypedSubscriber {
 public:
  struct State;  ///< internal to the library
  explicit UntypedSubscriber(std::unique_ptr<State> state);
  ~UntypedSubscriber();
  UntypedSubscriber(UntypedSubscriber&&) noexcept;
  UntypedSubscriber& operator=(UntypedSubscriber&&) noexcept;

  /// Number of matched writers.
  [[nodiscard]] int matched() const;
  /// Replaces `writers` by the identifiers of the matched writers. A writer can be missing when its first
  /// sample is taken.
  void matched_writers(std::vector<WriterId>& writers) const;
  /// Origin of a writer, for messages: "crane_tracking, pid 123 on HOST, 0110..." with the GUID prefix. A
  /// program can announce any name. Empty when nothing is known. Slow: searches the announcements
  [[nodiscard]] std::string origin_of(const WriterId& writer) const;
  [[nodiscard]] const ReaderCounts& counts() const;
  [[nodiscard]] const topics::Description& topic() const;

 protected:
  /// Copies the oldest intact sample that was not yet taken to `sample`. @return false when there is none
  [[nodiscard]] bool receive(void* sample, SampleInfo* info);

 private:
  std::unique_ptr<State> state_;
};

template <class T>
class Subscriber : public UntypedSubscriber {
 public:
  explicit Subscriber(UntypedSubscriber&& untyped) : UntypedSubscriber{std::move(untyped)} {}
  /// @return the oldest intact sample that was not yet taken; nothing when there is none. A sample without
  ///   data (its instance was disposed) is returned only when `info` is given; `info->valid` is then false
  std::optional<T> take(SampleInfo* info = nullptr) {
    std::optional<T> sample{std::in_place};
    if (!receive(&*sample, info)) sample.reset();
    return sample;
  }
  /// Takes a sample like take(), without a copy: overwrites `sample`.
  /// @return false when there is no sample; `sample` then has no defined value
  [[nodiscard]] bool take_into(T& sample, SampleInfo* info = nullptr) { return receive(&sample, info); }
};

/// Reader of any topic, for tools. It returns plain-CDR bytes (little endian, with the 4-byte encapsulation
/// header), in the form in which recordings store them.
class CdrSubscriber : public UntypedSubscriber {
 public:
  explicit CdrSubscriber(UntypedSubscriber&& untyped);
  /// Writes the bytes of the next intact sample to `cdr`. @return its header; nothing when there is no sample
  std::optional<msg::Header> take(std::vector<std::uint8_t>& cdr, SampleInfo* info = nullptr);

 private:
  std::vector<std::uint8_t> sample_;
};

}  // namespace crane::bus
