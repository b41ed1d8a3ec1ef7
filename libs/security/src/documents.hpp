#pragma once
/// Governance and permissions as the DDS Security specification 1.1 writes them, not yet signed.
#include <string>

#include "crane/security/keys.hpp"

namespace crane::security {

/// Unauthenticated participants are refused; discovery, liveliness and every topic are encrypted and need a
/// permission. Of the protections that both vendors implement, this is the strongest set that all four pairs
/// of them understand.
[[nodiscard]] std::string governance_document();
[[nodiscard]] std::string permissions_document(const Role& role, const std::string& subject,
                                               const Validity& validity);

}  // namespace crane::security
