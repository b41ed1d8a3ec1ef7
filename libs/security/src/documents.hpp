#pragma once
/// Governance and permissions documents of the DDS Security specification 1.1, without signature.
#include <filesystem>
#include <string>

#include "crane/security/keys.hpp"

namespace crane::security {

/// Refuses unauthenticated participants, encrypts discovery, liveliness and every topic, and requires a
/// permission for every topic: the strongest set of protections that all four pairs of the two vendors
/// support.
[[nodiscard]] std::string governance_document();
[[nodiscard]] std::string permissions_document(const Role& role, const std::string& subject,
                                               const Validity& validity);
/// Content of a file; empty when it cannot be read.
[[nodiscard]] std::string contents_of(const std::filesystem::path& file);

}  // namespace crane::security
