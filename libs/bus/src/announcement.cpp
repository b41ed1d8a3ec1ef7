#include "announcement.hpp"

#include <charconv>
#include <optional>

#include "crane/bus/announcement.hpp"
#include "crane/fields/printable.hpp"

namespace crane::bus {
namespace {

constexpr std::string_view kBegin = "crane messages=";
constexpr std::string_view kCrane = " crane=";
constexpr std::string_view kParticipant = " participant=";
// bytes; another program has chosen the name, which can have any length
constexpr std::size_t kMostShown = 256;

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
  found.participant = fields::printable(text.substr(name + kParticipant.size()), kMostShown);
  return found;
}

std::string announcement(const Options& options) {
  return std::string{kBegin} + std::to_string(options.messages_version) + std::string{kCrane} +
         options.crane + std::string{kParticipant} + options.participant;
}

void Census::note(const Key& participant, std::string_view user_data) {
  const auto found = parse_announcement(user_data);
  if (!found || found->crane != crane_ || found->version == version_) return;
  const std::lock_guard lock{mutex_};
  others_[participant] = {found->participant, found->version};
}

void Census::forget(const Key& participant) {
  const std::lock_guard lock{mutex_};
  others_.erase(participant);
}

std::vector<OtherVersion> Census::others() const {
  const std::lock_guard lock{mutex_};
  std::vector<OtherVersion> others;
  for (const auto& [key, other] : others_) others.push_back(other);
  return others;
}

std::string refusal(const OtherVersion& other, std::uint32_t own_version) {
  return other.participant + " has messages of version " + std::to_string(other.version) +
         ", this program has version " + std::to_string(own_version) +
         ": run programs of one release, or give each crane its own --crane or --domain";
}

}  // namespace crane::bus
