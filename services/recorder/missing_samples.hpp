#pragma once
/// Counts each missing sample of one topic once, although two sources report the loss: DDS, and the
/// gap in the ticks of the received samples. The two reports can be more than a second apart, in
/// either order: after a pause of the recorder DDS reports first; after a late heartbeat of the
/// writer, the gap is visible first.
#include <array>
#include <cstdint>
#include <vector>

#include "crane/recording/loss.hpp"

namespace crane::recorder {

class MissingSamples {
 public:
  /// A gap and a report wait this long for each other; together they count once. After this time, the first
  /// of the two counts, and the second does not count when it arrives.
  static constexpr std::int64_t kWait_ns = 1'000'000'000;

  struct Found {
    recording::LossCause cause;
    std::uint64_t samples;
    std::int64_t time_ns;  ///< log time of the newest gap or report
  };

  /// @param every_tick  true: the writer of the topic publishes every tick, so that gaps are visible
  explicit MissingSamples(bool every_tick) : every_tick_{every_tick} {}

  /// A sample has arrived, and its writer published nothing in the `ticks` ticks before; 0: no gap.
  void gap(std::uint64_t ticks, std::int64_t now_ns);
  /// DDS has lost samples (dds_lost), or the recorder has rejected samples (wrong_crc).
  void report(recording::LossCause cause, std::uint64_t samples, std::int64_t now_ns);
  /// Another writer has begun: no gap will reveal the losses of the previous writer.
  void begin_writer();
  /// @param all  true: also the gaps and reports that still wait for each other
  /// @return losses to write to the recording now
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
  std::uint64_t awaited_ = 0;  ///< samples counted by a report, whose gap is not visible yet
  std::uint64_t noted_ = 0;    ///< samples counted by a gap, which DDS has not reported yet
};

}  // namespace crane::recorder
