#pragma once
/// Access rules: who may look and who may operate, decided from the headers of a request. Pure.
#include <string>
#include <string_view>
#include <vector>

namespace crane::dashboard {

/// Sender of a request, from its connection and headers.
struct Visitor {
  /// true: the connection comes from this computer, not through a proxy that identifies itself
  bool loop_back = false;
  std::string_view host{};         ///< header Host
  std::string_view origin{};       ///< header Origin; empty: no browser, or a page of the same origin
  std::string_view fetched{};      ///< header Sec-Fetch-Site; empty: an old browser, or none
  std::string_view fetched_for{};  ///< header Sec-Fetch-Dest: "document" for a followed link
  std::string_view token{};        ///< token of the header Authorization: Bearer; empty: none
  bool token_ignored =
      false;  ///< true: the token is not compared, because the client sent too many wrong ones
};

struct AccessRules {
  /// Operator token, required to operate; empty: only this computer may operate, without a token.
  std::string token;
  std::vector<std::string>
      host_names;  ///< names of this computer, in addition to its addresses and localhost
  std::vector<std::string>
      other_origins;       ///< origins of other pages that may look: "https://app.foxglove.dev"
  bool read_only = false;  ///< true: nobody may operate
};

/// The header Host must be an address, localhost or one of `host_names`: a foreign name that resolves to this
/// computer (DNS rebinding) is refused.
[[nodiscard]] bool host_allowed(const AccessRules& rules, const Visitor& visitor);
/// A page of another origin may not look, unless `other_origins` names its origin. It may link to the page.
[[nodiscard]] bool may_look(const AccessRules& rules, const Visitor& visitor);
/// @return the reason why this visitor may not operate; empty: permitted
[[nodiscard]] std::string why_not_operate(const AccessRules& rules, const Visitor& visitor);
/// The same for a stop. This computer may request a stop without the token.
[[nodiscard]] std::string why_not_stop(const AccessRules& rules, const Visitor& visitor);
/// True when the visitor sends a wrong token.
[[nodiscard]] bool guesses(const AccessRules& rules, const Visitor& visitor);

/// Compares in constant time: the duration does not show where the texts differ.
[[nodiscard]] bool equal_in_constant_time(std::string_view a, std::string_view b);
/// 128 random bits as hexadecimal digits. @throws std::runtime_error when the system has no random numbers
[[nodiscard]] std::string random_token();

}  // namespace crane::dashboard
