#pragma once
/// Binds a reader of a loop topic to one writer. No I/O and no clock; time and the matched writers are
/// arguments.
///
/// The first writer whose kind of process may write the topic is bound, provided that it is the only writer.
/// A sample from another DDS writer, or with another source or start-up number in its header, is foreign: the
/// reader drops the sample, and the topic counts as disputed. A restarted process takes over after the bound
/// writer has sent nothing for kSilence_ns. Supervisor and bridge stop the crane earlier (stale_after_s):
/// when another writer takes over, the crane already waits for an operator.
///
/// Matched writers are compared by their identifiers, not counted: the first sample of a writer can be taken
/// before DDS counts the writer as matched. A killed process remains matched until its lease ends (10 s).
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "crane/bus/bus.hpp"

namespace crane::runtime {

/// Origin of one sample.
struct Writer {
  bus::WriterId id{};
  crane_Source source = crane_SOURCE_NONE;
  std::uint32_t epoch = 0;
  [[nodiscard]] bool operator==(const Writer&) const = default;
};

class WriterBinding {
 public:
  /// A writer that has sent nothing for this time has ended, hangs or is disconnected. The value is four
  /// times the maximum age of a command that the bridge accepts at 100 Hz.
  static constexpr std::int64_t kSilence_ns = 200'000'000;
  /// A topic remains disputed for this time after the last detection. Same value as clear_time_s:
  /// the time without a cause before the supervisor accepts a reset.
  static constexpr std::int64_t kDispute_ns = 1'000'000'000;

  explicit WriterBinding(const topics::Description& topic) : topic_{&topic} {}

  enum class Verdict : std::uint8_t {
    own,         ///< the sample is from the bound writer
    taken_over,  ///< the sample is from a new bound writer; samples of the old writer must be discarded
    foreign      ///< the sample is from another writer and must be dropped
  };
  /// Judges the origin of a sample that is taken at `now_ns`. @param matched  identifiers of the matched
  /// writers; the writer of the sample may be missing
  [[nodiscard]] Verdict judge(const Writer& writer, std::int64_t now_ns,
                              std::span<const bus::WriterId> matched);
  /// Refuses a sample that no process of the stack has sent (SampleInfo::entered is false), for every writer.
  void refuse_forged(const Writer& writer, std::int64_t now_ns);
  /// Fast path of judge() for the bound writer, without the matched writers. @return false for every other
  /// writer; then call judge()
  [[nodiscard]] bool is_own(const Writer& writer, std::int64_t now_ns) {
    if (bound_ != writer) return false;
    heard_ns_ = now_ns;
    return true;
  }
  /// Detects a second writer that is matched and has sent no sample. Call once per tick.
  void watch(std::int64_t now_ns, std::span<const bus::WriterId> matched);

  /// @return true when a second writer was detected within the last kDispute_ns
  [[nodiscard]] bool disputed(std::int64_t now_ns) const {
    return disputed_ns_ && now_ns - *disputed_ns_ < kDispute_ns;
  }
  [[nodiscard]] std::uint64_t foreign() const { return foreign_; }  ///< number of dropped samples
  [[nodiscard]] bool bound() const { return bound_.has_value(); }
  /// Describes a DDS writer, for messages; empty when nothing is known.
  using OriginOf = std::function<std::string(const bus::WriterId&)>;
  /// The dispute, for messages: "accepted: supervisor 4711 (ORIGIN), silent for 12 ms; refused: supervisor
  /// 4712 (ORIGIN), 3 samples". The numbers are start-up numbers; the silence is measured at the
  /// last detection.
  [[nodiscard]] std::string dispute(const OriginOf& origin_of) const;
  [[nodiscard]] const topics::Description& topic() const { return *topic_; }

 private:
  [[nodiscard]] bool silent(std::int64_t now_ns) const { return now_ns - heard_ns_ >= kSilence_ns; }
  void bind(const Writer& writer, std::int64_t now_ns, std::span<const bus::WriterId> matched);
  Verdict refuse(const Writer& writer, std::int64_t now_ns);
  void detected(std::int64_t now_ns);

  const topics::Description* topic_;
  std::optional<Writer> bound_;
  std::optional<Writer> rival_;  ///< the last refused writer; source SOURCE_NONE: it has sent no sample
  bool forged_ = false;          ///< true: the rival has sent a sample in the name of a process of the stack
  std::int64_t heard_ns_ = 0;    ///< time of the last sample of the bound writer
  std::optional<std::int64_t> disputed_ns_;
  std::int64_t silence_ns_ = 0;          ///< of the bound writer at the last detection
  std::vector<bus::WriterId> departed_;  ///< replaced writers that DDS still matches
  std::uint64_t foreign_ = 0;
};

}  // namespace crane::runtime
