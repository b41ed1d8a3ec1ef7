#pragma once
/// Counts each missing sample of one topic once, although two sources show it: a report of DDS, and a gap in
/// the ticks. The gap becomes visible with the next sample. The report can precede the gap by more than a
/// second when the recorder has stopped receiving, and can follow it by more than a second when the heartbeat
/// that reports the loss is late.
#include <array>
#include <cstdint>
#include <vector>

#include "crane/recording/loss.hpp"

namespace crane::recorder {

class MissingSamples {
 public:
  /// A gap and a report wait this long for each other; together they count once. After this time, the one
  /// that has arrived counts alone, and the other one does not count when it arrives later.
  static constexpr std::int64_t kWait_ns = 1'000'000'000;

  struct Found {
    recording::LossCause cause;
    std::uint64_t samples;
    std::int64_t time_ns;  ///< log time of the newest gap or report
  };

  /// @param every_tick  the writer of the topic publishes every tick, so that gaps are visible
  explicit MissingSamples(bool every_tick) : every_tick_{every_tick} {}

  /// A sample has arrived after `ticks` ticks without a sample of the same writer; 0: no gap.
  void gap(std::uint64_t ticks, std::int64_t now_ns);
  /// DDS has lost samples (dds_lost), or the recorder has rejected samples (wrong_crc).
  void report(recording::LossCause cause, std::uint64_t samples, std::int64_t now_ns);
  /// Another writer has begun: the losses of the previous one have no gap any more.
  void begin_writer();
  /// @param all  also the gaps and reports that still wait for each other
  /// @return what must be noted now
  [[nodiscard]] std::vector<Found> take(std::int64_t now_ns, bool all);

 private:
  struct Waiting {
    std::uint64_t samples = 0;
    std::int64_t first_ns = 0, newest_ns = 0;
    void add(std::uint64_t more, std::int64_t now_ns);
    [[nodiscard]] bool due(std::int64_t now_ns, bool all) const;
  };
  struct Report {
    recording::LossCause cause;
    Waiting waiting{};
  };
  bool every_tick_;
  Waiting gap_;  ///< ticks without a sample and without a report
  std::array<Report, 2> reports_{
      {{.cause = recording::LossCause::wrong_crc}, {.cause = recording::LossCause::dds_lost}}};
  std::uint64_t awaited_ = 0;  ///< samples that were noted as reported; their gap is not visible yet
  std::uint64_t noted_ = 0;    ///< ticks that were noted as a gap; DDS has not reported them yet
};

}  // namespace crane::recorder
