#pragma once
/// Access rules: decide from the headers of a request whether its sender may watch and may operate.
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
  std::string_view fetched{};      ///< header Sec-Fetch-Site; empty: an old browser, or no browser
  std::string_view fetched_for{};  ///< header Sec-Fetch-Dest: "document" for a followed link
  std::string_view token{};        ///< token of the header Authorization: Bearer; empty: none
  /// true: the token is not compared, because the client has sent too many wrong tokens
  bool token_ignored = false;
};

struct AccessRules {
  /// Operator token, required to operate; empty: only this computer may operate, without a token.
  std::string token;
  /// Names of this computer, in addition to its addresses and localhost.
  std::vector<std::string> host_names;
  /// Origins of other pages that may watch: "https://app.foxglove.dev".
  std::vector<std::string> other_origins;
  bool read_only = false;  ///< true: nobody may operate
};

/// True when the header Host is an address, localhost or one of `host_names`. Any other name that resolves to
/// this computer may be an attack by DNS rebinding.
[[nodiscard]] bool host_allowed(const AccessRules& rules, const Visitor& visitor);
/// False for a page of another origin, unless `other_origins` contains its origin or the page only links to
/// the dashboard.
[[nodiscard]] bool may_look(const AccessRules& rules, const Visitor& visitor);
/// @return the reason why this visitor may not operate; empty: permitted
[[nodiscard]] std::string why_not_operate(const AccessRules& rules, const Visitor& visitor);
/// As why_not_operate(), for a stop: this computer may request a stop without the token.
[[nodiscard]] std::string why_not_stop(const AccessRules& rules, const Visitor& visitor);
/// True when the visitor sends a wrong token.
[[nodiscard]] bool sends_wrong_token(const AccessRules& rules, const Visitor& visitor);

/// Compares in constant time, so that the duration does not reveal where the texts differ.
[[nodiscard]] bool equal_in_constant_time(std::string_view a, std::string_view b);
/// 128 random bits as hexadecimal digits. @throws std::runtime_error when the system has no random numbers
[[nodiscard]] std::string random_token();

}  // namespace crane::dashboard
