#include "dashboard/access.hpp"

#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <openssl/sha.h>

#include <algorithm>
#include <array>
#include <boost/asio/ip/address.hpp>
#include <stdexcept>

namespace crane::dashboard {
namespace {

/// True for "" and ":8765".
bool is_port(std::string_view text) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return text.empty() || (text.starts_with(':') && std::ranges::all_of(text.substr(1), digit));
}

/// "127.0.0.1:8765" -> "127.0.0.1", "[::1]:8765" -> "::1". @return empty for a malformed header
std::string_view without_port(std::string_view host) {
  const bool v6 = host.starts_with('[');
  const auto end = v6 ? host.find(']') : std::min(host.find(':'), host.size());
  if (end == std::string_view::npos || !is_port(host.substr(end + (v6 ? 1 : 0)))) return {};
  return v6 ? host.substr(1, end - 1) : host.substr(0, end);
}

bool is_address(std::string_view text) {
  boost::system::error_code error;
  boost::asio::ip::make_address(std::string{text}, error);
  return !error;
}

bool same_origin(const Visitor& visitor) {
  return visitor.origin == "http://" + std::string{visitor.host} ||
         visitor.origin == "https://" + std::string{visitor.host};
}

/// True when the headers prove that the request comes from a page of this server: no page of another origin
/// can send these headers.
bool is_own_page(const Visitor& visitor) {
  return visitor.fetched.empty() || visitor.fetched == "same-origin" || visitor.fetched == "none";
}

}  // namespace

bool host_allowed(const AccessRules& rules, const Visitor& visitor) {
  const auto name = without_port(visitor.host);
  return name == "localhost" || is_address(name) ||
         std::ranges::find(rules.host_names, name) != rules.host_names.end();
}

bool may_look(const AccessRules& rules, const Visitor& visitor) {
  if (!host_allowed(rules, visitor)) return false;
  if (std::ranges::find(rules.other_origins, visitor.origin) != rules.other_origins.end()) return true;
  return (visitor.origin.empty() || same_origin(visitor)) &&
         (is_own_page(visitor) || visitor.fetched_for == "document");
}

std::string why_not_operate(const AccessRules& rules, const Visitor& visitor) {
  if (rules.read_only) return "this dashboard was started with --read-only: it does not operate the crane";
  if (!host_allowed(rules, visitor) || (!visitor.origin.empty() && !same_origin(visitor)) ||
      !is_own_page(visitor))
    return "the request comes from another page than the dashboard's own";
  if (rules.token.empty())
    return visitor.loop_back
               ? ""
               : "from another computer this dashboard is read-only: start it with --operator-token FILE";
  if (visitor.token_ignored) return "too many wrong tokens from this computer: try again in a second";
  if (visitor.token.empty()) return "the operator token is needed";
  return sends_wrong_token(rules, visitor) ? "the operator token is wrong" : "";
}

std::string why_not_stop(const AccessRules& rules, const Visitor& visitor) {
  if (!visitor.loop_back || rules.read_only) return why_not_operate(rules, visitor);
  AccessRules without_token = rules;
  without_token.token.clear();
  return why_not_operate(without_token, visitor);
}

bool sends_wrong_token(const AccessRules& rules, const Visitor& visitor) {
  return !rules.token.empty() && !visitor.token.empty() &&
         !equal_in_constant_time(rules.token, visitor.token);
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  std::array<std::array<unsigned char, SHA256_DIGEST_LENGTH>, 2>
      digest{};  // digests have the same length for all texts
  SHA256(reinterpret_cast<const unsigned char*>(a.data()), a.size(), digest[0].data());
  SHA256(reinterpret_cast<const unsigned char*>(b.data()), b.size(), digest[1].data());
  return CRYPTO_memcmp(digest[0].data(), digest[1].data(), SHA256_DIGEST_LENGTH) == 0;
}

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
    throw std::runtime_error("cannot make a token: OpenSSL has no source of random numbers");
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const auto byte : bytes) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

}  // namespace crane::dashboard
