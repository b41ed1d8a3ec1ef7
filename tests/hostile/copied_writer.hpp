#pragma once
/// Forged RTPS packets with the GUID of a genuine writer.
#include <utility>
#include <vector>

#include "forged.hpp"
#include "wire.hpp"

namespace crane::hostile {

/// Forges the next samples of one writer. A HEARTBEAT makes its readers skip the next sequence numbers of the
/// writer; the forged packets use the numbers after the skipped ones.
template <class T>
class CopiedWriter {
 public:
  /// @param message  contains a sample of the writer
  /// @param to       ports that receive the forged packets
  CopiedWriter(Bytes message, std::vector<sockaddr_in> to, const topics::Topic<T>& topic)
      : topic_{topic}, to_{std::move(to)}, message_{alone(message, find(message, topic).value().data)} {
    found_ = find(message_, topic).value();
    constexpr std::uint64_t kAhead = 10'000;  // Fast DDS needs 60 ns for each skipped number
    number_ = sequence_number_of(message_, found_.data) + kAhead;
    send(heartbeat(prefix_of(message_), entities_of(message_, found_.data).writer, number_));
  }
  CopiedWriter(const Packet& model, const topics::Topic<T>& topic)
      : CopiedWriter{model.message, {model.to}, topic} {}

  /// The sample that this object has copied.
  [[nodiscard]] const T& model() const { return found_.sample; }
  void send(T sample) {
    const auto& own = found_.sample.header;
    sample.header.source = own.source;
    sample.header.epoch = own.epoch;
    replace(message_, found_.data, topic_, sample);
    set_sequence_number(message_, found_.data, number_++);
    send(message_);
  }
  [[nodiscard]] std::uint64_t sent() const { return mouth_.sent(); }

 private:
  void send(const Bytes& message) {
    for (const auto& to : to_) mouth_.send({to, message});
  }

  const topics::Topic<T>& topic_;
  std::vector<sockaddr_in> to_;
  Bytes message_;
  Found<T> found_{};
  std::uint64_t number_ = 0;
  Mouth mouth_;
};

}  // namespace crane::hostile
