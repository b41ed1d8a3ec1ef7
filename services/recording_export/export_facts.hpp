#pragma once
/// Parts that the exports to HDF5 and MATLAB share.
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "crane/recording/columns.hpp"

namespace crane::recording_export {

/// What a recording says about itself: "exported_by", "recording", "messages_version", the entries of its
/// metadata ("crane.domain"), the texts of its attachments ("rig.toml").
[[nodiscard]] std::map<std::string, std::string> export_facts(recording::McapReader& recording);

/// Unit of all elements of the column, empty: none. @return nothing when the elements have different units
[[nodiscard]] std::optional<std::string> common_unit(const recording::Column& column);

/// FILE.partial, which becomes FILE when it is complete.
class PartialFile {
 public:
  explicit PartialFile(std::filesystem::path file);
  /// Removes FILE.partial, unless finish() was called.
  ~PartialFile();
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  [[nodiscard]] std::string name() const { return partial_.string(); }
  /// @throws std::runtime_error
  void finish() const;

 private:
  std::filesystem::path file_, partial_;
};

}  // namespace crane::recording_export
