#pragma once
/// Reads the elementary values of samples as numbers, without JSON: for samples that arrive at the rate of
/// the loop.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "crane/recording/schema.hpp"

namespace crane::recording {

/// Made by Schema::number_reader().
class NumberReader {
 public:
  [[nodiscard]] std::size_t size() const { return steps_.size(); }  ///< number of values

  /// Writes every value in the order of Schema::leaves(): numbers in their own unit, a boolean as 0 or 1, an
  /// enumerator as its number, a text as NaN. Integers beyond 2^53 are rounded.
  /// @param payload  plain CDR with the 4-byte encapsulation header
  /// @param values   at least size() numbers
  /// @throws DecodeError when the payload is too short or too long, or is not plain CDR
  void read(std::span<const std::uint8_t> payload, std::span<double> values) const;

 private:
  friend class Schema;
  struct Step {
    std::size_t bytes = 0;  ///< of the value; of a text: 0
    double (*value)(std::uint64_t raw) = nullptr;
  };
  std::string type_;
  std::vector<Step> steps_;
};

}  // namespace crane::recording
