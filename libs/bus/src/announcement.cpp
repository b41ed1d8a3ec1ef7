#include "announcement.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <climits>
#include <optional>
#include <span>

#include "crane/bus/announcement.hpp"
#include "crane/fields/printable.hpp"

namespace crane::bus {
namespace {

constexpr std::string_view kBegin = "crane messages=";
constexpr std::string_view kCrane = " crane=";
constexpr std::string_view kParticipant = " participant=";
constexpr std::string_view kProcess = " process=";
constexpr std::string_view kHost = " host=";
// bytes; another program has chosen the name, which can have any length
constexpr std::size_t kMostShown = 256;

std::string host_name() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::string hexadecimal(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const auto byte : bytes) text += {kDigits[byte >> 4U], kDigits[byte & 0xfU]};
  return text;
}

}  // namespace

std::optional<Announcement> parse_announcement(std::string_view text) {
  if (!text.starts_with(kBegin)) return std::nullopt;
  text.remove_prefix(kBegin.size());
  Announcement found;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), found.version);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  const auto name = text.rfind(kParticipant);  // names of participants contain no space
  if (!text.starts_with(kCrane) || name == std::string_view::npos || name < kCrane.size())
    return std::nullopt;
  found.crane = fields::printable(text.substr(kCrane.size(), name - kCrane.size()), kMostShown);
  text.remove_prefix(name + kParticipant.size());
  if (const auto process = text.find(kProcess); process != std::string_view::npos) {
    auto rest = text.substr(process + kProcess.size());
    text = text.substr(0, process);
    const auto [last, wrong] = std::from_chars(rest.data(), rest.data() + rest.size(), found.pid);
    if (wrong == std::errc{}) rest.remove_prefix(static_cast<std::size_t>(last - rest.data()));
    if (rest.starts_with(kHost)) found.host = fields::printable(rest.substr(kHost.size()), kMostShown);
  }
  found.participant = fields::printable(text, kMostShown);
  return found;
}

std::string announcement(const Options& options) {
  return std::string{kBegin} + std::to_string(options.messages_version) + std::string{kCrane} +
         options.crane + std::string{kParticipant} + options.participant + std::string{kProcess} +
         std::to_string(::getpid()) + std::string{kHost} + host_name();
}

void Census::note(const Key& participant, std::string_view user_data) {
  const auto found = parse_announcement(user_data);
  if (!found || found->crane != crane_) return;
  const std::lock_guard lock{mutex_};
  if (announced_.size() < kMost) announced_[participant] = *found;
}

void Census::forget(const Key& participant) {
  const std::lock_guard lock{mutex_};
  announced_.erase(participant);
}

std::vector<OtherVersion> Census::others() const {
  const std::lock_guard lock{mutex_};
  std::vector<OtherVersion> others;
  for (const auto& [key, other] : announced_)
    if (other.version != version_) others.push_back({other.participant, other.version});
  return others;
}

std::string Census::origin_of(const ParticipantId& participant) const {
  if (participant == kUnknownParticipant) return {};
  const auto prefix = hexadecimal(participant);
  const std::lock_guard lock{mutex_};
  const auto found = std::ranges::find_if(announced_, [&](const auto& entry) {
    return std::equal(participant.begin(), participant.end(), entry.first.begin());
  });
  if (found == announced_.end()) return prefix;
  const auto& program = found->second;
  return program.participant + ", pid " + std::to_string(program.pid) + " on " + program.host + ", " + prefix;
}

std::string refusal(const OtherVersion& other, std::uint32_t own_version) {
  return other.participant + " has messages of version " + std::to_string(other.version) +
         ", this program has version " + std::to_string(own_version) +
         ": run programs of one release, or give each crane its own --crane or --domain";
}

}  // namespace crane::bus
