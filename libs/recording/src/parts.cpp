#include "crane/recording/parts.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace crane::recording {
namespace {

/// A million parts: 11 days of one part per second.
constexpr std::size_t kFewestDigits = 6;

/// @return number of the part; nothing when `name` is not PREFIXnnnnnnSUFFIX
std::optional<std::uint32_t> number_in(std::string_view name, std::string_view prefix,
                                       std::string_view suffix) {
  if (name.size() < prefix.size() + kFewestDigits + suffix.size() || !name.starts_with(prefix) ||
      !name.ends_with(suffix))
    return std::nullopt;
  name.remove_prefix(prefix.size());
  name.remove_suffix(suffix.size());
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc{} || end != name.data() + name.size() || number == 0) return std::nullopt;
  return number;
}

}  // namespace

std::filesystem::path part_file(const std::filesystem::path& recording, std::uint32_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < kFewestDigits) digits.insert(0, kFewestDigits - digits.size(), '0');
  auto file = recording;
  return file.replace_filename(recording.stem().string() + "_" + digits + recording.extension().string());
}

std::vector<Part> parts_of(const std::filesystem::path& recording) {
  const auto prefix = recording.stem().string() + "_", suffix = recording.extension().string();
  const auto directory = recording.has_parent_path() ? recording.parent_path() : std::filesystem::path{"."};
  std::vector<Part> parts;
  std::error_code error;
  for (std::filesystem::directory_iterator entry{directory, error}, end; !error && entry != end;
       entry.increment(error)) {
    const auto number = number_in(entry->path().filename().string(), prefix, suffix);
    if (number && part_file(recording, *number).filename() == entry->path().filename())
      parts.push_back({*number, part_file(recording, *number)});
  }
  std::ranges::sort(parts, {}, &Part::number);
  return parts;
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& recording) {
  std::error_code ignored;
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::exists(recording, ignored))
    for (const auto& part : parts_of(recording)) files.push_back(part.file);
  if (files.empty()) files.push_back(recording);
  return files;
}

}  // namespace crane::recording
