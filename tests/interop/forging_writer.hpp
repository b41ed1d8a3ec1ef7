#pragma once
/// A Fast DDS writer that sends any bytes as the payload of a topic, like an attacker or a defective program.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "crane/topics.hpp"

namespace crane::bus::testing {

class ForgingWriter {
 public:
  ForgingWriter(std::uint32_t domain, const std::string& partition, const topics::Description& topic);
  ~ForgingWriter();
  /// @param payload with the encapsulation header
  bool send(std::vector<std::uint8_t> payload);
  [[nodiscard]] int matched() const;

 private:
  struct Entities;
  std::unique_ptr<Entities> entities_;
};

}  // namespace crane::bus::testing
