#include "cli/stick_keys.hpp"

#include <algorithm>

namespace crane::cli {
namespace {

struct Sequence {
  std::string_view bytes;
  std::size_t axis;
  double share;
};
constexpr double kMicroShare = StickKeys::kMicro;
/// xterm: arrows, page keys, and the same with shift.
constexpr std::array kSequences{Sequence{"\x1b[A", 0, 1},
                                Sequence{"\x1b[B", 0, -1},
                                Sequence{"\x1b[C", 1, 1},
                                Sequence{"\x1b[D", 1, -1},
                                Sequence{"\x1b[5~", 2, -1},
                                Sequence{"\x1b[6~", 2, 1},
                                Sequence{"\x1bOA", 0, 1},
                                Sequence{"\x1bOB", 0, -1},
                                Sequence{"\x1bOC", 1, 1},
                                Sequence{"\x1bOD", 1, -1},
                                Sequence{"\x1b[1;2A", 0, kMicroShare},
                                Sequence{"\x1b[1;2B", 0, -kMicroShare},
                                Sequence{"\x1b[1;2C", 1, kMicroShare},
                                Sequence{"\x1b[1;2D", 1, -kMicroShare},
                                Sequence{"\x1b[5;2~", 2, -kMicroShare},
                                Sequence{"\x1b[6;2~", 2, kMicroShare}};

}  // namespace

void StickKeys::press(std::size_t axis, double share, double now_s) {
  Key& key = key_[axis];
  const bool repeats = key.share == share && now_s <= key.until_s;
  key = {share, now_s + (repeats ? kRepeat_s : kFirst_s)};
  last_s_ = now_s;
}

/// Takes one key from the front. @return false when the bytes are the beginning of a sequence
bool StickKeys::take_sequence(double now_s) {
  if (pending_.front() == '\x1b') {
    bool begins = false;
    for (const auto& [bytes, axis, share] : kSequences) {
      if (pending_.starts_with(bytes)) {
        press(axis, share, now_s);
        pending_.erase(0, bytes.size());
        return true;
      }
      begins = begins || bytes.starts_with(pending_);
    }
    if (begins) return false;
  } else if (pending_.front() == ' ') {
    key_ = {};
    last_s_ = -1;
  } else if (pending_.front() == 'q') {
    quits_ = true;
  } else if (pending_.front() == 'm') {
    micro_ = !micro_;
  }
  pending_.erase(0, 1);
  return true;
}

void StickKeys::take(std::string_view bytes, double now_s) {
  pending_ += bytes;
  while (!pending_.empty() && take_sequence(now_s)) continue;
}

std::array<double, 3> StickKeys::deflection(double now_s) const {
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < key_.size(); ++i) {
    if (now_s > key_[i].until_s) continue;
    result[i] = micro_ ? std::clamp(key_[i].share, -kMicro, kMicro) : key_[i].share;
  }
  return result;
}

}  // namespace crane::cli
