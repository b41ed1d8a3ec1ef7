#include "recording_export/export_facts.hpp"

#include <algorithm>
#include <stdexcept>
#include <system_error>

#include "crane/recording/run_table.hpp"

namespace crane::recording_export {
namespace {

struct RemovedAtTheEnd {
  std::filesystem::path file;
  ~RemovedAtTheEnd() {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
};

}  // namespace

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

void write_completely(const std::filesystem::path& file,
                      const std::function<void(const std::string& partial)>& write) {
  const RemovedAtTheEnd partial{file.string() + ".partial"};
  try {
    write(partial.file.string());
  } catch (const recording::DecodeError&) {
    throw;
  } catch (const recording::SchemaError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
  std::error_code failure;
  std::filesystem::rename(partial.file, file, failure);
  if (failure)
    throw std::runtime_error(file.string() + ": cannot rename " + partial.file.string() + ": " +
                             failure.message());
}

}  // namespace crane::recording_export
