#include "recorder/recording_thread.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>

namespace crane::recorder {

using std::chrono::steady_clock;

RecordingThread::RecordingThread(RecordingFiles files, std::size_t capacity)
    : files_{std::move(files)}, capacity_{capacity}, thread_{[this] { run(); }} {}

bool RecordingThread::put(Entry entry) {
  {
    const std::lock_guard lock{mutex_};
    if (failure_ || closing_ || waiting_.size() >= capacity_) {
      ++dropped_;
      note_loss(entry.channel, recording::LossCause::queue_full, 1, entry.log_time_ns);
      return false;
    }
    waiting_.push_back(std::move(entry));
  }
  arrived_.notify_one();
  return true;
}

void RecordingThread::lose(std::uint16_t channel, recording::LossCause cause, std::uint64_t samples,
                           std::int64_t time_ns) {
  const std::lock_guard lock{mutex_};
  lost_ += samples;
  note_loss(channel, cause, samples, time_ns);
}

void RecordingThread::note_loss(std::uint16_t channel, recording::LossCause cause, std::uint64_t samples,
                                std::int64_t time_ns) {
  auto& loss = losses_[{channel, cause}];
  if (loss.samples == 0) loss.from_ns = time_ns;
  loss.cause = cause;
  loss.samples += samples;
  loss.until_ns = time_ns;
}

std::vector<std::string> RecordingThread::take_warnings() {
  const std::lock_guard lock{mutex_};
  return std::exchange(warnings_, {});
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
    dropped_ += waiting_.size() + batch_.size() - done_;
    waiting_.clear();
  }
}

void RecordingThread::write_until_closed() {
  constexpr std::chrono::seconds kFlushPeriod{1};
  auto flush_at = steady_clock::now() + kFlushPeriod;
  for (bool last = false; !last;) {
    {
      std::unique_lock lock{mutex_};
      arrived_.wait_until(lock, flush_at, [this] { return closing_ || !waiting_.empty(); });
      batch_.swap(waiting_);
      last = closing_;
    }
    bool flush = steady_clock::now() >= flush_at;
    for (done_ = 0; done_ < batch_.size(); ++done_) {
      files_.write(batch_[done_]);
      ++written_;
      flush = flush || batch_[done_].urgent;
    }
    batch_.clear();
    done_ = 0;
    if (flush) {
      write_losses();
      files_.flush();
      flush_at = steady_clock::now() + kFlushPeriod;
    }
    show_state();
  }
  write_losses();
  files_.close();
  show_state();
}

void RecordingThread::write_losses() {
  Losses losses;
  {
    const std::lock_guard lock{mutex_};
    losses.swap(losses_);
  }
  for (auto& [key, loss] : losses) {
    loss.topic = files_.topic(key.first);
    files_.write(std::move(loss));
  }
}

void RecordingThread::show_state() {
  bytes_ = files_.bytes();
  parts_ = files_.parts();
  auto warnings = files_.take_warnings();
  const std::lock_guard lock{mutex_};
  std::ranges::move(warnings, std::back_inserter(warnings_));
}

}  // namespace crane::recorder
