#pragma once
/// A new recording that contains parts of other recordings; used by repair, cut and merge.
#include <filesystem>
#include <map>
#include <span>

#include "crane/files/complete_file.hpp"
#include "crane/recording/mcap_reader.hpp"

namespace crane::recording {

/// True when both schemas define the same types.
[[nodiscard]] bool have_equal_types(const SchemaRecord& a, const SchemaRecord& b);

class RecordingCopy {
 public:
  /// Writes a file beside FILE. @throws WriteError, also as CompleteFile
  RecordingCopy(const std::filesystem::path& file, std::span<const std::filesystem::path> sources);
  using ChannelIds = std::map<std::uint16_t, std::uint16_t>;  ///< of a source -> of the copy
  /// Adds the schemas and channels of a source; those that the copy already has are added once.
  [[nodiscard]] ChannelIds add_channels(const McapReader& source);
  /// Adds the metadata and attachments of a source; those that the copy already has are added once.
  void add_attachments(McapReader& source);
  void add_metadata(const std::string& name, const Metadata& entries);
  void add(const Message& message, const ChannelIds& channels);

  /// Renames this file to FILE. @return number of messages. @throws WriteError
  std::uint64_t finish();

 private:
  files::CompleteFile file_;
  McapWriter writer_;
  std::map<std::uint16_t, SchemaRecord> schemas_;    ///< of the copy, by id
  std::map<std::uint16_t, ChannelRecord> channels_;  ///< of the copy, by id
  std::vector<MetadataRecord> metadata_;
  std::vector<AttachmentRecord> attachments_;
};

}  // namespace crane::recording
