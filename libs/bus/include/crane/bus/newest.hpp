#pragma once
/// Newest sample of a topic.
#include <optional>
#include <utility>

#include "crane/bus/endpoints.hpp"

namespace crane::bus {

/// Takes all samples that have arrived. @param newest  becomes the last one; unchanged when none has arrived
/// @return true when a sample has arrived
template <class T>
bool take_newest(Subscriber<T>& subscriber, std::optional<T>& newest) {
  bool any = false;
  for (auto sample = subscriber.take(); sample; sample = subscriber.take()) {
    newest = std::move(sample);
    any = true;
  }
  return any;
}

}  // namespace crane::bus
