#include "crane/recording/mcap_edit.hpp"

#include <algorithm>
#include <cmath>

#include "crane/recording/csv.hpp"
#include "recording_copy.hpp"

namespace crane::recording {
namespace {

using std::filesystem::path;

constexpr auto kEarliest_ns = std::numeric_limits<std::int64_t>::min();

/// Log time of a time of a range; limited to the range of the type.
std::int64_t log_time_ns(std::int64_t first_ns, double time_s) {
  constexpr double kLargest_s = 9e9;  // 285 years
  const double limited_s = std::clamp(time_s, -kLargest_s, kLargest_s);
  const auto offset_ns = static_cast<std::int64_t>(std::llround(limited_s * 1e9));
  std::int64_t sum_ns = 0;
  if (!__builtin_add_overflow(first_ns, offset_ns, &sum_ns)) return sum_ns;
  return offset_ns < 0 ? kEarliest_ns : std::numeric_limits<std::int64_t>::max();
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

/// Compares the schemas, channels and attachments of two recordings.
class Contradictions {
 public:
  Contradictions(const path& a, const path& b) : files_{a.string() + " and " + b.string()} {}

  void compare_schemas(const McapReader& a, const McapReader& b) {
    for (const auto& left : a.schemas())
      for (const auto& right : b.schemas())
        if (left.name == right.name && !have_equal_types(left, right))
          note("type " + left.name + ": different schemas");
  }
  void compare_channels(const McapReader& a, const McapReader& b) {
    for (const auto& left : a.channels())
      for (const auto& right : b.channels())
        if (left.topic == right.topic &&
            (left.message_encoding != right.message_encoding || type_of(a, left) != type_of(b, right)))
          note("topic " + left.topic + ": different types or encodings");
  }
  void compare_attachments(McapReader& a, McapReader& b) {
    const auto others = b.attachments();
    for (const auto& left : a.attachments())
      for (const auto& right : others) {
        const bool rigs = left.media_type == kToml && right.media_type == kToml;
        if ((left.name == right.name || rigs) && left.data != right.data)
          note("attachments " + left.name + (left.name == right.name ? "" : " and " + right.name) +
               ": different content");
      }
  }
  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }

 private:
  static constexpr const char* kToml = "application/toml";
  static std::string type_of(const McapReader& reader, const ChannelRecord& channel) {
    const auto* schema = reader.find_schema(channel.schema_id);
    return schema == nullptr ? "" : schema->name;
  }
  void note(const std::string& what) { lines_.push_back(files_ + ": " + what); }

  std::string files_;
  std::vector<std::string> lines_;
};

void require_agreement(std::span<const path> files, std::vector<McapReader>& readers) {
  std::vector<std::string> problems;
  std::error_code ignored;
  for (std::size_t b = 1; b < readers.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      if (std::filesystem::equivalent(readers[a].files().front(), readers[b].files().front(), ignored))
        problems.push_back(files[b].string() + ": is given twice");
      Contradictions found{files[a], files[b]};
      found.compare_schemas(readers[a], readers[b]);
      found.compare_channels(readers[a], readers[b]);
      found.compare_attachments(readers[a], readers[b]);
      problems.insert(problems.end(), found.lines().begin(), found.lines().end());
    }
  if (!problems.empty()) throw EditError(joined(problems));
}

/// A recording of a merge with its next message.
struct Source {
  MessageStream stream;
  RecordingCopy::ChannelIds channels;
  const Message* next;  ///< nullptr after the last one
};

void merge_messages(std::vector<Source>& sources, RecordingCopy& copy) {
  for (;;) {
    Source* earliest = nullptr;
    for (auto& source : sources)
      if (source.next != nullptr &&
          (earliest == nullptr || source.next->log_time_ns < earliest->next->log_time_ns))
        earliest = &source;
    if (earliest == nullptr) return;
    copy.add(*earliest->next, earliest->channels);
    earliest->next = earliest->stream.next();
  }
}

}  // namespace

Selection selection_of(const McapReader& recording, const TimeRange& range) {
  const auto first_ns = recording.first_time_ns();
  const auto end_ns = log_time_ns(first_ns, range.until_s);
  return {.topics = {},
          .from_ns = log_time_ns(first_ns, range.from_s),
          .until_ns = std::max(end_ns, kEarliest_ns + 1) - 1};
}

CheckReport cut(const path& file, const TimeRange& range, const path& out) {
  McapReader reader{file};
  auto messages = reader.messages(selection_of(reader, range));
  const auto* message = range.from_s < range.until_s ? messages.next() : nullptr;
  if (message == nullptr)
    throw EditError(file.string() + ": no message from " + shortest(range.from_s) + " s to " +
                    shortest(range.until_s) + " s; the recording has " +
                    shortest(static_cast<double>(reader.last_time_ns() - reader.first_time_ns()) / 1e9) +
                    " s");
  RecordingCopy copy{out, reader.files()};
  const auto channels = copy.add_channels(reader);
  copy.add_attachments(reader);
  copy.add_metadata("cut", {{"file", file.filename().string()},
                            {"from_s", shortest(range.from_s)},
                            {"until_s", shortest(range.until_s)}});
  for (; message != nullptr; message = messages.next()) copy.add(*message, channels);
  CheckReport report;
  report.messages = copy.finish();
  report.problems = reader.problems();
  return report;
}

CheckReport merge(std::span<const path> files, const path& out) {
  std::vector<McapReader> readers;
  for (const auto& file : files) readers.emplace_back(file);
  require_agreement(files, readers);
  std::vector<path> read;
  for (const auto& reader : readers) read.insert(read.end(), reader.files().begin(), reader.files().end());
  RecordingCopy copy{out, read};
  std::vector<Source> sources;
  Metadata names;
  for (std::size_t i = 0; i < readers.size(); ++i) {
    sources.push_back({readers[i].messages(), copy.add_channels(readers[i]), nullptr});
    sources.back().next = sources.back().stream.next();
    names["file_" + std::to_string(i + 1)] = files[i].filename().string();
  }
  for (auto& reader : readers) copy.add_attachments(reader);
  copy.add_metadata("merge", names);
  merge_messages(sources, copy);
  CheckReport report;
  report.messages = copy.finish();
  for (const auto& reader : readers)
    report.problems.insert(report.problems.end(), reader.problems().begin(), reader.problems().end());
  return report;
}

}  // namespace crane::recording
