#pragma once
/// Whose samples of a loop topic count: exactly one writer's. Pure; time and the number of matched writers
/// come in as arguments.
///
/// The first writer whose kind may write the topic is bound, if it is the only one. From then on every sample
/// that does not come from it (another DDS writer, another source or another start-up number in the header)
/// is foreign: it is not handed out, and the topic is disputed. A process that was started anew takes over
/// only after the bound writer has been silent for kSilence_ns; whoever moves the crane has stopped long
/// before (stale_after_s), so that a takeover always ends in a state that waits for an operator.
#include <cstdint>
#include <optional>
#include <string>

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
  /// A writer that has been silent for so long is dead, hung or cut off: four times the largest age of a
  /// command that the bridge accepts at 100 Hz.
  static constexpr std::int64_t kSilence_ns = 200'000'000;
  /// How long a dispute lasts after its last sign: the supervisor wants its causes clear for as long.
  static constexpr std::int64_t kDispute_ns = 1'000'000'000;

  explicit WriterBinding(const topics::Description& topic) : topic_{&topic} {}

  enum class Verdict : std::uint8_t {
    own,         ///< of the bound writer
    taken_over,  ///< of a new bound writer: what the old one said is void
    foreign      ///< of anybody else: to be dropped
  };
  /// Judges the origin of a sample that is taken at `now_ns`. @param matched  writers matched now
  [[nodiscard]] Verdict judge(const Writer& writer, std::int64_t now_ns, int matched);
  /// Notices a second writer that says nothing yet. Call once per tick.
  void watch(std::int64_t now_ns, int matched);

  /// More than one writer was noticed within the last kDispute_ns.
  [[nodiscard]] bool disputed(std::int64_t now_ns) const {
    return disputed_ns_ && now_ns - *disputed_ns_ < kDispute_ns;
  }
  [[nodiscard]] std::uint64_t foreign() const { return foreign_; }  ///< samples dropped so far
  [[nodiscard]] bool bound() const { return bound_.has_value(); }
  /// Who disputes the topic, for a message: "a writer that calls itself supervisor, start-up number 4711".
  [[nodiscard]] std::string rival() const;
  [[nodiscard]] const topics::Description& topic() const { return *topic_; }

 private:
  [[nodiscard]] bool silent(std::int64_t now_ns) const { return now_ns - heard_ns_ >= kSilence_ns; }
  void bind(const Writer& writer, std::int64_t now_ns, int matched);
  Verdict refuse(const Writer& writer, std::int64_t now_ns);

  const topics::Description* topic_;
  std::optional<Writer> bound_, rival_;
  std::int64_t heard_ns_ = 0;  ///< when the bound writer's last sample was taken
  std::optional<std::int64_t> disputed_ns_;
  int departed_ = 0;  ///< matched writers that a takeover has left behind and DDS has not yet given up
  std::uint64_t foreign_ = 0;
};

}  // namespace crane::runtime
