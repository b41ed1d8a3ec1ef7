#pragma once
/// Files of data with hidden effects. The diagnosis uses only the data files; the answer is read afterwards.
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

/// Owner of a temporary directory.
class SealedCase {
 public:
  /// Writes train_N.csv, test_N.csv and answer.json.
  /// @throws std::invalid_argument, std::runtime_error when the crane cannot have the effect or leaves its
  /// range
  explicit SealedCase(const truth::Case& request);
  ~SealedCase();
  SealedCase(const SealedCase&) = delete;
  SealedCase& operator=(const SealedCase&) = delete;

  /// Diagnoses the CSV files.
  [[nodiscard]] Diagnosis diagnosed(const Request& request = {}) const;
  /// Opens answer.json.
  [[nodiscard]] std::vector<HiddenEffect> answer() const;

 private:
  std::string rig_;
  std::filesystem::path directory_;
};

/// Rig file of the truth's rig, without effects.
[[nodiscard]] configuration::Rig rig_file_of(const std::string& truth_rig);

}  // namespace crane::diagnosis::score
