#pragma once
/// Writes an incident as a recording: samples, metadata, rig file.
#include <filesystem>

#include "black_box/incidents.hpp"
#include "crane/recording/mcap_writer.hpp"

namespace crane::black_box {

/// Metadata of every file of this process.
struct Origin {
  recording::Metadata crane;       ///< "crane", "domain", "version", "host", "kernel", "cores", ...
  std::string rig_name, rig_text;  ///< rig file, which is attached; empty: unknown
};

/// "20261125T035501Z_SWING_LIMIT": UTC and first cause, without extension. Sorted by name, the files are in
/// the order of time unless the clock was set back.
[[nodiscard]] std::string file_name_of(const Incident& incident);

/// Writes the file, which appears when it is complete. Creates the directory if it is missing. If a file of
/// this name exists (a second part of one fault, or another crane), the file gets the first free name of
/// NAME_2.mcap, NAME_3.mcap, ...
/// @return its path. @throws recording::WriteError
std::filesystem::path write_incident(const std::filesystem::path& directory, const Incident& incident,
                                     const Origin& origin, const recording::Metadata& processes);

/// Deletes the oldest incident files until `files` remain, and unfinished files that are at least 10 minutes
/// old and whose process has ended. Deletes no other file, and never `written`.
///
/// The modification times give the age. If another incident file has a later modification time than `written`
/// (the clock was set back), `written` receives a modification time 1 us after the latest one: the files keep
/// the order in which they were written.
/// @param written  the file that write_incident() has returned last
void keep_newest(const std::filesystem::path& directory, std::size_t files,
                 const std::filesystem::path& written) noexcept;

}  // namespace crane::black_box
