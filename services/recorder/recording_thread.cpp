#include "recorder/recording_thread.hpp"

#include <chrono>

namespace crane::recorder {

using std::chrono::steady_clock;

RecordingThread::RecordingThread(recording::McapWriter writer, std::size_t capacity)
    : writer_{std::move(writer)}, capacity_{capacity}, thread_{[this] { run(); }} {}

bool RecordingThread::put(Entry entry) {
  {
    const std::lock_guard lock{mutex_};
    if (failure_ || closing_ || waiting_.size() >= capacity_) {
      ++dropped_;
      return false;
    }
    waiting_.push_back(std::move(entry));
  }
  arrived_.notify_one();
  return true;
}

void RecordingThread::close() {
  {
    const std::lock_guard lock{mutex_};
    closing_ = true;
  }
  arrived_.notify_one();
  if (thread_.joinable()) thread_.join();
}

std::optional<std::string> RecordingThread::failure() const {
  const std::lock_guard lock{mutex_};
  return failure_;
}

void RecordingThread::run() {
  try {
    write_until_closed();
  } catch (const recording::WriteError& error) {
    const std::lock_guard lock{mutex_};
    failure_ = error.what();
    dropped_ += waiting_.size();
    waiting_.clear();
  }
}

void RecordingThread::write_until_closed() {
  constexpr std::chrono::seconds kFlushPeriod{1};
  auto flush_at = steady_clock::now() + kFlushPeriod;
  std::vector<Entry> batch;
  for (bool last = false; !last;) {
    {
      std::unique_lock lock{mutex_};
      arrived_.wait_until(lock, flush_at, [this] { return closing_ || !waiting_.empty(); });
      batch.swap(waiting_);
      last = closing_;
    }
    bool flush = steady_clock::now() >= flush_at;
    for (const auto& entry : batch) {
      writer_.message(entry.channel, entry.sequence, entry.log_time_ns, entry.publish_time_ns, entry.data);
      ++written_;
      flush = flush || entry.urgent;
    }
    batch.clear();
    if (flush) {
      writer_.flush();
      flush_at = steady_clock::now() + kFlushPeriod;
    }
    bytes_ = writer_.bytes_written();
  }
  writer_.close();
  bytes_ = writer_.bytes_written();
}

}  // namespace crane::recorder
