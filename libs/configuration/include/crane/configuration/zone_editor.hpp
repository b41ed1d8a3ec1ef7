#pragma once
/// Adds and removes zones in the text of a rig file. All other text, including comments, does not change. The
/// functions parse the new text, and return it only if the rigs differ in this zone only.
#include <filesystem>
#include <string>

#include "crane/configuration/rig.hpp"

namespace crane::configuration {

/// Appends the table [[zone]]. @throws ConfigurationError when the rig file has problems with or without the
/// zone, or when its zones cannot be extended by a table at its end (an inline array, zones of a base file)
[[nodiscard]] std::string with_zone(const std::string& text, const std::string& file,
                                    const control::Zone& zone);

/// Removes the table [[zone]] of this name with the comments between its keys. @throws ConfigurationError
[[nodiscard]] std::string without_zone(const std::string& text, const std::string& file,
                                       const std::string& name);

/// Text of the rig file `from` for the new place `to`: a relative `extends` becomes an absolute path when the
/// directory changes. @throws ConfigurationError when the text describes another rig at the new place
[[nodiscard]] std::string moved(const std::string& text, const std::filesystem::path& from,
                                const std::filesystem::path& to);

}  // namespace crane::configuration
