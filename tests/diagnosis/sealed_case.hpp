#pragma once
/// Data with hidden effects as files, diagnosed from the files alone; the answer stays closed until the
/// diagnosis has spoken.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"
#include "truth/truth.hpp"

namespace crane::diagnosis::score {

struct HiddenEffect {
  std::string name, axis;
  bool in_library = true;
  std::map<std::string, double> parameters;  ///< names and units of the truth
};

/// A directory of its own, removed again.
class SealedCase {
 public:
  /// Writes train_N.csv, test_N.csv and answer.json.
  /// @throws std::invalid_argument, std::runtime_error when the crane cannot have it or leaves its range
  explicit SealedCase(const truth::Case& request);
  ~SealedCase();
  SealedCase(const SealedCase&) = delete;
  SealedCase& operator=(const SealedCase&) = delete;

  /// Of the CSV files.
  [[nodiscard]] Diagnosis diagnosed(const Request& request = {}) const;
  /// Opens answer.json.
  [[nodiscard]] std::vector<HiddenEffect> answer() const;

 private:
  std::string rig_;
  std::filesystem::path directory_;
};

/// The rig file that describes the truth's rig of that name without its effects.
[[nodiscard]] configuration::Rig rig_file_of(const std::string& truth_rig);

}  // namespace crane::diagnosis::score
