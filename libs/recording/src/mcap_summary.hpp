#pragma once
/// The end of an MCAP file: summary, offsets, footer.
#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace crane::recording::mcap {

/// First and last log time of the added messages.
struct TimeSpan {
  std::int64_t first = 0, last = 0;
  bool empty = true;
  void add(std::int64_t time_ns) {
    first = empty ? time_ns : std::min(first, time_ns);
    last = empty ? time_ns : std::max(last, time_ns);
    empty = false;
  }
};

class Summary {
 public:
  /// Records that the summary repeats or indexes.
  std::vector<std::string> schemas, channels, chunks, attachments, metadata;
  std::map<std::uint16_t, std::uint64_t> counts;  ///< messages per channel
  TimeSpan span;                                  ///< log times of all messages

  /// Appends to one of the lists of records.
  void keep(std::vector<std::string>& records, std::string record_bytes);
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }  ///< of the records
  [[nodiscard]] std::uint64_t messages() const;

  /// The bytes that close a file. @param base  size of the file before them
  [[nodiscard]] std::string closing(std::uint64_t base) const;

 private:
  std::uint64_t bytes_ = 0;
};

}  // namespace crane::recording::mcap
