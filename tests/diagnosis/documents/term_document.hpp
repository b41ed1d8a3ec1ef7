#pragma once
/// Generates the list of the model terms in docs/terms.md.
#include <set>
#include <string>

namespace crane::test {

/// @param candidates     terms that are a candidate of crane diagnose
/// @param causes_of_twin terms that are a cause of the live twin
[[nodiscard]] std::string term_list(const std::set<std::string>& candidates,
                                    const std::set<std::string>& causes_of_twin);

}  // namespace crane::test
