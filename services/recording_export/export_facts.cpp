#include "recording_export/export_facts.hpp"

#include <algorithm>
#include <stdexcept>

#include "crane/files/complete_file.hpp"
#include "crane/recording/run_table.hpp"

namespace crane::recording_export {
std::map<std::string, std::string> export_facts(recording::McapReader& recording) {
  std::map<std::string, std::string> facts{{"exported_by", "crane " CRANE_VERSION}};
  std::string files;
  for (const auto& file : recording.files()) files += (files.empty() ? "" : ", ") + file.filename().string();
  facts["recording"] = files;
  if (const auto version = recording::messages_version(recording))
    facts["messages_version"] = std::to_string(*version);
  for (const auto& record : recording.metadata()) {
    if (record.name == "part") continue;  // "recording" names all parts
    for (const auto& [key, value] : record.entries) facts.insert_or_assign(record.name + "." + key, value);
  }
  for (const auto& attachment : recording.attachments())
    if (attachment.media_type.starts_with("application/toml") || attachment.media_type.starts_with("text/"))
      facts.insert_or_assign(attachment.name, std::string{attachment.data.begin(), attachment.data.end()});
  return facts;
}

std::optional<std::string> common_unit(const recording::Column& column) {
  if (column.units.empty()) return std::string{};
  const bool equal =
      std::ranges::all_of(column.units, [&](const auto& unit) { return unit == column.units[0]; });
  return equal ? std::optional{column.units[0]} : std::nullopt;
}

void write_completely(const std::filesystem::path& file, const recording::McapReader& recording,
                      const std::function<void(const std::string& partial)>& write) {
  files::CompleteFile out{file, recording.files()};
  try {
    write(out.partial().string());
  } catch (const recording::DecodeError&) {
    throw;
  } catch (const recording::SchemaError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
  out.publish();
}

}  // namespace crane::recording_export
