#pragma once
/// When one fitted hypothesis is better than another.
#include <cstdint>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {

/// A score this unlikely by luck is something.
inline constexpr double kSignificant = 0.01;

[[nodiscard]] bool has(const Effects& effects, const Candidate* candidate);

/// "command_delay (trolley) + payload_mass"
[[nodiscard]] std::string label_of(const Effects& effects);

/// Number of blocks, training and held out.
[[nodiscard]] std::size_t blocks(const Fitted& fitted);

/// By training and held-out loss with a price for the parameters.
[[nodiscard]] bool less(const Fitted& a, const Fitted& b);

/// The same candidates, whatever their values.
[[nodiscard]] bool same(const Effects& a, const Effects& b);

/// Better in training by a share of what was left that matters, by more than the form of what `before` has on
/// the same axis may be off, and out of sample beyond doubt.
/// @param base without effects
[[nodiscard]] bool accepted(const Fitted& fitted, const Fitted& before, const Fitted& base,
                            std::uint64_t seed);
/// Better than `base` in training and held-out data together, beyond resampling.
[[nodiscard]] bool possible(const Fitted& fitted, const Fitted& base, std::uint64_t seed);

/// Better by a share that matters, in training or held-out data, and in all beyond doubt; the held-out data
/// agree, but may be too few to prove it.
[[nodiscard]] bool likely(const Fitted& fitted, const Fitted& base, std::uint64_t seed);

/// How often, when the blocks are resampled, each of the rivals does better than `best` where it would have
/// to replace what only `best` has; of a rival with fewer parameters, which explains nine tenths as much of
/// the training data, the held-out blocks alone suffice: what more parameters gain there has to hold out of
/// sample. The rest of the votes are for `best`.
/// @param base without effects
[[nodiscard]] std::vector<double> frequencies(const Fitted& best, const std::vector<const Fitted*>& rivals,
                                              const Fitted& base, std::uint64_t seed);

[[nodiscard]] std::vector<Estimate> estimates(const Fitted& fitted);

}  // namespace crane::diagnosis
