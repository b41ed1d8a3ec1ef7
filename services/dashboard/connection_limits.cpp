#include "dashboard/connection_limits.hpp"

#include <utility>

namespace crane::dashboard {

bool ConnectionLimits::has_place(const Client& client, Kind kind) const {
  std::size_t sum = 0;
  for (const auto& [other, count] : open_)
    if (other.foreign == client.foreign) sum += count.of(kind);
  return sum < (kind == Kind::viewer ? kMostViewers : kMostOfOneSide);
}

std::size_t ConnectionLimits::open(const Client& client, Kind kind) const {
  const auto found = open_.find(client);
  return found == open_.end() ? 0 : found->second.of(kind);
}

std::size_t ConnectionLimits::open() const {
  std::size_t sum = 0;
  for (const auto& [client, count] : open_) sum += count.connections;
  return sum;
}

bool ConnectionLimits::must_yield(const Client& holder, const Client& to, Kind kind) const {
  return holder.foreign == to.foreign && open(holder, kind) > open(to, kind);
}

void ConnectionLimits::remove(const Client& client, Kind kind) {
  const auto found = open_.find(client);
  --found->second.of(kind);
  if (found->second.connections == 0 && found->second.viewers == 0) open_.erase(found);
}

bool ConnectionLimits::reserve(std::size_t bytes) {
  if (!has_room(bytes)) return false;
  answers_bytes_ += bytes;
  return true;
}

Admission::Admission(std::shared_ptr<ConnectionLimits> limits, Client client)
    : limits_{std::move(limits)}, client_{std::move(client)} {
  limits_->add(client_, Kind::connection);
}

Admission::~Admission() {
  limits_->free(reserved_bytes_);
  if (viewer_) limits_->remove(client_, Kind::viewer);
  limits_->remove(client_, Kind::connection);
}

void Admission::become_viewer() {
  if (!std::exchange(viewer_, true)) limits_->add(client_, Kind::viewer);
}

bool Admission::reserve(std::size_t bytes) {
  limits_->free(std::exchange(reserved_bytes_, 0));
  if (bytes <= kShortAnswer_bytes) return true;
  if (!limits_->reserve(bytes)) return false;
  reserved_bytes_ = bytes;
  return true;
}

}  // namespace crane::dashboard
