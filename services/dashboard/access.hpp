#pragma once
/// Who may look and who may operate, from what a browser says about itself. Pure.
#include <string>
#include <string_view>
#include <vector>

namespace crane::dashboard {

/// What a request says about its sender.
struct Visitor {
  /// true: the connection comes from this computer, and no proxy that names itself has passed it on
  bool loop_back = false;
  std::string_view host{};         ///< header Host
  std::string_view origin{};       ///< header Origin; empty: no browser, or a page of the same origin
  std::string_view fetched{};      ///< header Sec-Fetch-Site; empty: an old browser, or none
  std::string_view fetched_for{};  ///< header Sec-Fetch-Dest: "document" where a link is followed
  std::string_view token{};        ///< of the header Authorization: Bearer; empty: none
};

struct AccessRules {
  /// Operator token, without which nobody operates; empty: this computer operates, and no other one.
  std::string token;
  std::vector<std::string> host_names;  ///< names of this computer beside its addresses and localhost
  std::vector<std::string>
      other_origins;       ///< origins of other pages that may look: "https://app.foxglove.dev"
  bool read_only = false;  ///< true: nobody operates
};

/// Host must be an address, localhost or one of `host_names`: a foreign name that is resolved to this
/// computer (DNS rebinding) is refused.
[[nodiscard]] bool host_allowed(const AccessRules& rules, const Visitor& visitor);
/// A page of another origin may not look, unless `other_origins` names its origin. It may link to the page.
[[nodiscard]] bool may_look(const AccessRules& rules, const Visitor& visitor);
/// Why this visitor may not operate; empty: he may.
[[nodiscard]] std::string why_not_operate(const AccessRules& rules, const Visitor& visitor);
/// The same for a stop, which this computer may ask for without the token.
[[nodiscard]] std::string why_not_stop(const AccessRules& rules, const Visitor& visitor);
/// The visitor gives a token, and it is not the right one.
[[nodiscard]] bool guesses(const AccessRules& rules, const Visitor& visitor);

/// Compares in a time that does not depend on where the texts differ.
[[nodiscard]] bool equal_in_constant_time(std::string_view a, std::string_view b);
/// 128 random bits as hexadecimal digits. @throws std::runtime_error when the system has no random numbers
[[nodiscard]] std::string random_token();

}  // namespace crane::dashboard
