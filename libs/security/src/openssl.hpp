#pragma once
/// Wraps the operations of OpenSSL that the keys need, with ownership and exceptions.
#include <openssl/evp.h>
#include <openssl/x509.h>

#include <filesystem>
#include <memory>
#include <string>

#include "crane/security/keys.hpp"

namespace crane::security::openssl {

template <auto Free>
struct Deleter {
  template <class T>
  void operator()(T* object) const {
    Free(object);
  }
};
using Key = std::unique_ptr<EVP_PKEY, Deleter<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Deleter<X509_free>>;

[[nodiscard]] Key make_key();  ///< EC prime256v1
/// @param issuer  null: an authority, which signs its own certificate
[[nodiscard]] Certificate certify(const std::string& common_name, EVP_PKEY& key, const Validity& validity,
                                  X509* issuer, EVP_PKEY& issuer_key);
/// First byte of SHA-256 over the subject of a certificate. The participant with the lower byte starts a
/// handshake.
[[nodiscard]] unsigned first_hash_byte(const std::string& common_name);
[[nodiscard]] unsigned first_hash_byte(const X509& certificate);

[[nodiscard]] std::string pem_of(X509& certificate);
[[nodiscard]] std::string pem_of(EVP_PKEY& key);
/// @return null when the text is not a certificate
[[nodiscard]] Certificate certificate_from(const std::string& pem);
[[nodiscard]] Key key_from(const std::string& pem);

[[nodiscard]] std::string subject_of(const X509& certificate);  ///< "CN=supervisor.cyclone.0"
[[nodiscard]] Validity validity_of(const X509& certificate);
[[nodiscard]] bool is_signed_by(X509& certificate, X509& authority);
[[nodiscard]] bool fits(X509& certificate, EVP_PKEY& key);

/// S/MIME with clear text and signature.
[[nodiscard]] std::string sign(const std::string& text, X509& signer, EVP_PKEY& key);
/// @return the signed text; empty when `signer` has not signed it or the text was changed
[[nodiscard]] std::string verified(const std::string& smime, X509& signer);

}  // namespace crane::security::openssl
