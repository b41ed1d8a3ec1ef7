#include "recorder/recording_files.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "crane/recording/parts.hpp"

namespace crane::recorder {
namespace {

bool same_file(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino && a.st_size == b.st_size &&
         a.st_mtim.tv_sec == b.st_mtim.tv_sec && a.st_mtim.tv_nsec == b.st_mtim.tv_nsec;
}

}  // namespace

RecordingFiles::RecordingFiles(std::filesystem::path recording, Limits limits, Prepare prepare)
    : recording_{std::move(recording)}, limits_{limits}, prepare_{std::move(prepare)} {
  begin_file();
}

/// Opens the next part, or the only file.
void RecordingFiles::begin_file() {
  ++number_;
  const bool first = number_ == 1;
  file_ = limits_.split() ? recording::part_file(recording_, number_) : recording_;
  // Only the first file may replace an existing one, because the caller has checked only the first.
  writer_.emplace(file_, recording::WriterOptions{.sync = true, .replace = first});
  topics_ = prepare_(*writer_);
  loss_channel_ = recording::add_loss_channel(*writer_);
  if (limits_.split())
    writer_->metadata("part",
                      {{"recording", recording_.filename().string()}, {"number", std::to_string(number_)}});
  contents_.assign(topics_.size(), {});
  losses_.clear();
}

bool RecordingFiles::exceeds_limit(const Entry& entry) const {
  if (part_ends_ns_ && entry.log_time_ns >= *part_ends_ns_) return true;
  const bool empty =
      std::ranges::all_of(contents_, [](const Content& content) { return content.samples == 0; });
  return limits_.part_bytes > 0 && !empty && writer_->closed_bytes(entry.data.size()) > limits_.part_bytes;
}

void RecordingFiles::write(const Entry& entry) {
  const auto length_ns = limits_.part.count();
  if (length_ns > 0 && !part_ends_ns_) part_ends_ns_ = entry.log_time_ns + length_ns;
  if (exceeds_limit(entry)) begin_part(entry.log_time_ns);
  writer_->message(entry.channel, entry.sequence, entry.log_time_ns, entry.publish_time_ns, entry.data);
  auto& content = contents_.at(entry.channel);
  if (content.samples++ == 0) content.first_ns = entry.log_time_ns;
  content.last_ns = entry.log_time_ns;
}

void RecordingFiles::write(recording::Loss loss) {
  recording::write_loss(*writer_, loss_channel_, loss);
  losses_.push_back(std::move(loss));
}

void RecordingFiles::begin_part(std::int64_t log_time_ns) {
  if (writer_->removed()) {
    replace_removed_file();
  } else {
    close_part();
    keep_quota();
    begin_file();
  }
  // Every part ends a whole number of lengths after the first sample.
  if (part_ends_ns_ && log_time_ns >= *part_ends_ns_) {
    const auto length_ns = limits_.part.count();
    *part_ends_ns_ += ((log_time_ns - *part_ends_ns_) / length_ns + 1) * length_ns;
  }
}

void RecordingFiles::close_part() {
  writer_->close();
  struct stat status {};
  if (::stat(file_.c_str(), &status) != 0) return;  // renamed or deleted meanwhile: no longer a part
  closed_.push_back({file_, writer_->bytes_written(), status});
  closed_bytes_ += writer_->bytes_written();
}

/// Deletes the oldest parts until there is room for another one.
void RecordingFiles::keep_quota() {
  if (limits_.quota_bytes == 0) return;
  while (!closed_.empty() && closed_bytes_ + limits_.part_bytes > limits_.quota_bytes) {
    const auto oldest = closed_.front();
    closed_.pop_front();
    closed_bytes_ -= oldest.bytes;
    struct stat status {};
    const bool ours = ::stat(oldest.file.c_str(), &status) == 0 && same_file(status, oldest.status);
    std::error_code error;
    if (ours) std::filesystem::remove(oldest.file, error);
    if (error)
      warnings_.push_back(oldest.file.string() +
                          ": cannot delete, so the recording exceeds its quota: " + error.message());
  }
}

void RecordingFiles::flush() {
  writer_->flush();
  if (writer_->removed()) replace_removed_file();
}

void RecordingFiles::replace_removed_file() {
  const auto removed = file_;
  auto losses = losses_;
  std::uint64_t samples = 0;
  for (std::size_t channel = 0; channel < contents_.size(); ++channel) {
    const auto& content = contents_[channel];
    if (content.samples == 0) continue;
    losses.push_back({.topic = topics_[channel],
                      .cause = recording::LossCause::file_removed,
                      .samples = content.samples,
                      .from_ns = content.first_ns,
                      .until_ns = content.last_ns});
    samples += content.samples;
  }
  begin_file();
  for (auto& loss : losses) write(std::move(loss));
  writer_->flush();
  warnings_.push_back(removed.string() + ": was deleted with " + std::to_string(samples) +
                      " samples while it was written; the recording continues in " + file_.string());
}

void RecordingFiles::close() {
  flush();
  writer_->close();
}

std::uint64_t RecordingFiles::bytes() const {
  return closed_bytes_ + (writer_ ? writer_->bytes_written() : 0);
}

std::vector<std::string> RecordingFiles::take_warnings() { return std::exchange(warnings_, {}); }

}  // namespace crane::recorder
