#pragma once
/// The files of a recording, opened and read as one recording.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "crane/recording/mcap_reader.hpp"
#include "crane/recording/parts.hpp"
#include "mcap_contents.hpp"

namespace crane::recording {

[[nodiscard]] inline Bytes as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

struct McapReader::State {
  explicit State(const std::filesystem::path& recording) : names{files_of(recording)} {
    if (names.size() > 1) find_gaps(parts_of(recording));
  }

  std::vector<std::filesystem::path> names;
  std::vector<std::unique_ptr<InputFile>> files;  // by part
  std::vector<Contents> opened;                   // moved to `contents`
  Contents contents;                              // of all parts
  std::vector<SchemaRecord> schemas;
  std::vector<ChannelRecord> channels;
  std::vector<std::string> problems;
  std::set<std::pair<std::size_t, std::uint64_t>> reported;  // places, to report each problem once
  bool indexed = true;

  void find_gaps(const std::vector<Part>& parts);
  void open();
  void open(const std::filesystem::path& name);
  void add(Contents part, std::size_t number);
  void require_one_recording();
  [[nodiscard]] MetadataRecord metadata_at(const Place& place) const;
  void report(const Place& place, const std::string& what);
  [[nodiscard]] std::string content_of(const Place& place) const;
  [[nodiscard]] const ChannelRecord* channel(std::uint16_t id) const;
};

}  // namespace crane::recording
