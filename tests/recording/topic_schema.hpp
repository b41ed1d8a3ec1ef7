// Fills the C structs of idlc and reads them back through the codec of the bus and the schema of crane.idl.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>
#include <type_traits>
#include <vector>

#include "crane/bus/cdr.hpp"
#include "crane/recording/schema.hpp"
#include "crane/topics.hpp"

namespace crane::recording {

using nlohmann::ordered_json;

/// Values that differ between fields.
class Filler {
 public:
  double real() { return 0.5 * ++count_ - 20; }
  template <class T>
  void number(T& value) {
    value = static_cast<T>(1'000'000 + ++count_);
  }
  template <class E>
  void enumeration(E& value, int choices) {
    value = static_cast<E>(++count_ % choices);
  }
  void flag(bool& value) { value = ++count_ % 2 == 0; }
  template <std::size_t N>
  void text(char (&value)[N]) {
    std::snprintf(value, N, "text %d", ++count_);
  }
  void header(msg::Header& h) {
    number(h.tick);
    h.sample_time_ns = -123456789012345;
    enumeration(h.source, 11);
    number(h.epoch);
  }
  void axis(msg::AxisReference& a) {
    a.position = real();
    a.speed = real();
    a.acceleration = real();
  }

 private:
  int count_ = 0;
};

inline const Schema& schema() {
  static const Schema kSchema{topics::idl_text()};
  return kSchema;
}

template <class T>
ordered_json through_the_codec(const topics::Topic<T>& topic, const T& sample) {
  const bus::CdrCodec& codec = bus::CdrCodec::of(*topic.description.descriptor);
  std::vector<std::uint8_t> payload(4 + codec.max_encoded_bytes());
  payload[1] = 1;
  const std::size_t size = codec.encode(&sample, std::span{payload}.subspan(4));
  EXPECT_GT(size, 0U);
  payload.resize(4 + size);
  return schema().decode(topic.description.type, payload);
}

inline ordered_json expected(const msg::Header& h) {
  const std::array names{"SOURCE_NONE",     "SOURCE_PLANT",      "SOURCE_BRIDGE",   "SOURCE_PLANNER",
                         "SOURCE_TRACKING", "SOURCE_ANTI_SWING", "SOURCE_FRICTION", "SOURCE_SUPERVISOR",
                         "SOURCE_OPERATOR", "SOURCE_RECORDER",   "SOURCE_MONITOR",  "SOURCE_TWIN"};
  return {{"tick", h.tick},
          {"sample_time_ns", h.sample_time_ns},
          {"source", names.at(h.source)},
          {"epoch", h.epoch}};
}
inline ordered_json expected(const msg::AxisReference& a) {
  return {{"position", a.position}, {"speed", a.speed}, {"acceleration", a.acceleration}};
}
template <class T, std::size_t N>
ordered_json expected(const T (&values)[N]) {
  ordered_json list = ordered_json::array();
  for (const T& value : values) {
    if constexpr (std::is_same_v<T, msg::AxisReference>)
      list.push_back(expected(value));
    else
      list.push_back(value);
  }
  return list;
}

}  // namespace crane::recording
