#include "verdict/losing_encoders.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "verdict/judgement.hpp"
#include "verdict/sentence.hpp"

namespace crane::diagnosis {
namespace {

constexpr const char* kTerm = "position_drift";

std::vector<Estimate> estimates(const LosingEncoder& encoder) {
  const bool turns = encoder.axis == kSlewAngle;
  return {{"rate", turns ? "rad/rad" : "m/m", encoder.rate, encoder.rate_std_dev},
          {"jump", turns ? "rad" : "m", encoder.jump, encoder.jump_std_dev}};
}

/// Adds a drift that was found on the axis to the loss of the same encoder, and removes it from the causes.
LosingEncoder in_all(LosingEncoder encoder, Diagnosis& diagnosis) {
  const std::string axis = axis_of(encoder.axis);
  for (const Cause& cause : diagnosis.causes) {
    if (cause.name != kTerm || cause.axis != axis) continue;
    encoder.rate += cause.parameters.at(0).value;
    encoder.rate_std_dev = std::hypot(encoder.rate_std_dev, cause.parameters.at(0).std_dev);
  }
  const auto is_drift = [&](const auto& named) { return named.name == kTerm && named.axis == axis; };
  std::erase_if(diagnosis.causes, is_drift);
  std::erase_if(diagnosis.extension, is_drift);
  return encoder;
}

std::string note(const LosingEncoder& encoder) {
  std::ostringstream text;
  text << axis_of(encoder.axis) << ": its encoder lost counts " << encoder.jumps << " times in "
       << encoder.duration_s << " s of training data, " << encoder.lost
       << (encoder.axis == kSlewAngle ? " rad" : " m")
       << " in all: jumps from one row to the next that no force explains; the jumps were removed before the "
          "rest of the model was judged";
  return text.str();
}

void rank(const Cause& cause, double train_gain, std::vector<Ranked>& ranking) {
  const std::string label = cause.name + " (" + cause.axis + ")";
  std::erase_if(ranking, [&](const Ranked& smooth) { return smooth.label == label; });
  ranking.insert(ranking.begin(),
                 {label, cause.parameters, train_gain, cause.p_value, cause.resampling_frequency});
}

}  // namespace

void name_losing(const std::vector<LosingEncoder>& losing, double train_gain, Diagnosis& diagnosis) {
  std::vector<Cause> causes;
  std::vector<plant::TermSetting> terms;
  for (const LosingEncoder& jumping : losing) {
    const LosingEncoder encoder = in_all(jumping, diagnosis);
    causes.push_back({.name = kTerm,
                      .axis = axis_of(encoder.axis),
                      .parameters = estimates(encoder),
                      .p_value = 0,
                      .resampling_frequency = 1});
    terms.push_back({kTerm, axis_of(encoder.axis), {{"rate", encoder.rate}, {"jump", encoder.jump}}});
    rank(causes.back(), train_gain, diagnosis.ranking);
    diagnosis.notes.push_back(note(encoder));
  }
  diagnosis.causes.insert(diagnosis.causes.begin(), causes.begin(), causes.end());
  diagnosis.extension.insert(diagnosis.extension.begin(), terms.begin(), terms.end());
  if (diagnosis.verdict == Verdict::none || diagnosis.verdict == Verdict::parameter)
    diagnosis.verdict = Verdict::named;
  diagnosis.sentence =
      (diagnosis.verdict == Verdict::unknown ? "An encoder loses counts. " : "") + sentence_of(diagnosis);
}

}  // namespace crane::diagnosis
