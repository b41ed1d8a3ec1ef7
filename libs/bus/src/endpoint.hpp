#pragma once
/// Writer and reader of one topic, without its type. Each back end implements both.
#include "crane/bus/bus.hpp"
#include "crane/bus/ledger.hpp"

namespace crane::bus {
namespace detail {

class Writer {
 public:
  virtual ~Writer() = default;
  virtual bool write(const void* sample) = 0;
  virtual bool dispose(const void* sample) = 0;
  virtual bool assert_liveliness() = 0;
  virtual bool wait_until_acknowledged(std::chrono::nanoseconds timeout) = 0;
  [[nodiscard]] virtual int matched() const = 0;
};

class Reader {
 public:
  virtual ~Reader() = default;
  /// Copies the oldest sample that was not yet taken. @return false when there is none
  virtual bool take(void* sample, SampleInfo& info) = 0;
  /// True when the last taken sample is, bit for bit, a sample that a publisher of this process has sealed
  /// for messages of this version: its CRC need not be computed again.
  [[nodiscard]] virtual bool delivered_as_sealed(std::uint32_t /*messages_version*/) const { return false; }
  [[nodiscard]] virtual int matched() const = 0;
  virtual void matched_writers(std::vector<WriterId>& writers) const = 0;
  [[nodiscard]] virtual std::string origin_of(const WriterId& /*writer*/) const { return {}; }
};

}  // namespace detail

struct UntypedPublisher::State {
  const topics::Description& topic;
  std::unique_ptr<detail::Writer> writer;
  crane_Source source;
  std::uint32_t epoch, messages_version;
  std::shared_ptr<Ledger> ledger;  ///< null: not a loop topic, or no ledger
};

struct UntypedSubscriber::State {
  const topics::Description& topic;
  bool has_texts;
  std::unique_ptr<detail::Reader> reader;
  std::uint32_t messages_version;
  std::shared_ptr<Ledger> ledger;  ///< as in UntypedPublisher::State
  ReaderCounts counts{};
};

}  // namespace crane::bus
