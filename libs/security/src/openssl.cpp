#include "openssl.hpp"

#include <openssl/asn1.h>
#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/rand.h>
#include <openssl/sha.h>
#include <openssl/x509v3.h>

#include <array>
#include <ctime>
#include <stdexcept>

namespace crane::security::openssl {
namespace {

using Bio = std::unique_ptr<BIO, Deleter<BIO_free>>;
using Name = std::unique_ptr<X509_NAME, Deleter<X509_NAME_free>>;
using Signed = std::unique_ptr<PKCS7, Deleter<PKCS7_free>>;

void require(bool done, const char* what) {
  if (done) return;
  const auto code = ERR_get_error();
  throw std::runtime_error{std::string{"OpenSSL cannot "} + what +
                           (code != 0 ? std::string{": "} + ERR_reason_error_string(code) : "")};
}

Bio reader_of(const std::string& text) {
  return Bio{BIO_new_mem_buf(text.data(), static_cast<int>(text.size()))};
}
Bio writer() { return Bio{BIO_new(BIO_s_mem())}; }
std::string text_of(BIO& bio) {
  char* data = nullptr;
  const auto size = BIO_get_mem_data(&bio, &data);
  return {data, static_cast<std::size_t>(size)};
}

Name name_of(const std::string& common_name) {
  Name name{X509_NAME_new()};
  require(
      X509_NAME_add_entry_by_txt(name.get(), "CN", MBSTRING_UTF8,
                                 reinterpret_cast<const unsigned char*>(common_name.c_str()), -1, -1, 0) == 1,
      "name a certificate");
  return name;
}

unsigned first_hash_byte(const X509_NAME& name) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> hash{};
  unsigned char* der = nullptr;
  const int size = i2d_X509_NAME(&name, &der);
  require(size > 0, "encode a subject");
  SHA256(der, static_cast<std::size_t>(size), hash.data());
  OPENSSL_free(der);
  return hash[0];
}

void set_random_serial(X509& certificate) {
  std::array<unsigned char, 8> bytes{};
  require(RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) == 1, "draw a serial number");
  std::uint64_t number = 0;
  for (const auto byte : bytes) number = number << 8U | byte;
  ASN1_INTEGER_set_uint64(X509_get_serialNumber(&certificate), number >> 1U);
}

void add_extension(X509& certificate, int kind, const char* value) {
  X509V3_CTX context{};
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, &certificate, &certificate, nullptr, nullptr, 0);
  std::unique_ptr<X509_EXTENSION, Deleter<X509_EXTENSION_free>> extension{
      X509V3_EXT_conf_nid(nullptr, &context, kind, value)};
  require(extension && X509_add_ext(&certificate, extension.get(), -1) == 1, "extend a certificate");
}

std::int64_t seconds_of(const ASN1_TIME& time) {
  std::tm parts{};
  if (ASN1_TIME_to_tm(&time, &parts) != 1) return 0;
  return ::timegm(&parts);
}

}  // namespace

Key make_key() {
  Key key{EVP_EC_gen("prime256v1")};
  require(key != nullptr, "make a key");
  return key;
}

Certificate certify(const std::string& common_name, EVP_PKEY& key, const Validity& validity, X509* issuer,
                    EVP_PKEY& issuer_key) {
  Certificate certificate{X509_new()};
  const bool authority = issuer == nullptr;
  const Name subject = name_of(common_name);
  X509_set_version(certificate.get(), X509_VERSION_3);
  set_random_serial(*certificate);
  ASN1_TIME_set(X509_getm_notBefore(certificate.get()), validity.from_s);
  ASN1_TIME_set(X509_getm_notAfter(certificate.get()), validity.until_s);
  X509_set_subject_name(certificate.get(), subject.get());
  X509_set_issuer_name(certificate.get(), authority ? subject.get() : X509_get_subject_name(issuer));
  X509_set_pubkey(certificate.get(), &key);
  add_extension(*certificate, NID_basic_constraints, authority ? "critical,CA:TRUE" : "critical,CA:FALSE");
  add_extension(*certificate, NID_key_usage, authority ? "keyCertSign,digitalSignature" : "digitalSignature");
  require(X509_sign(certificate.get(), &issuer_key, EVP_sha256()) > 0, "sign a certificate");
  return certificate;
}

unsigned first_hash_byte(const std::string& common_name) { return first_hash_byte(*name_of(common_name)); }
unsigned first_hash_byte(const X509& certificate) {
  return first_hash_byte(*X509_get_subject_name(&certificate));
}

std::string pem_of(X509& certificate) {
  const Bio bio = writer();
  require(PEM_write_bio_X509(bio.get(), &certificate) == 1, "write a certificate");
  return text_of(*bio);
}

std::string pem_of(EVP_PKEY& key) {
  const Bio bio = writer();
  require(PEM_write_bio_PrivateKey(bio.get(), &key, nullptr, nullptr, 0, nullptr, nullptr) == 1,
          "write a key");
  return text_of(*bio);
}

Certificate certificate_from(const std::string& pem) {
  return Certificate{PEM_read_bio_X509(reader_of(pem).get(), nullptr, nullptr, nullptr)};
}
Key key_from(const std::string& pem) {
  return Key{PEM_read_bio_PrivateKey(reader_of(pem).get(), nullptr, nullptr, nullptr)};
}

std::string subject_of(const X509& certificate) {
  const Bio bio = writer();
  X509_NAME_print_ex(bio.get(), X509_get_subject_name(&certificate), 0, XN_FLAG_RFC2253);
  return text_of(*bio);
}

Validity validity_of(const X509& certificate) {
  return {seconds_of(*X509_get0_notBefore(&certificate)), seconds_of(*X509_get0_notAfter(&certificate))};
}

bool is_signed_by(X509& certificate, X509& authority) {
  return X509_NAME_cmp(X509_get_issuer_name(&certificate), X509_get_subject_name(&authority)) == 0 &&
         X509_verify(&certificate, X509_get0_pubkey(&authority)) == 1;
}

bool fits(X509& certificate, EVP_PKEY& key) { return X509_check_private_key(&certificate, &key) == 1; }

std::string sign(const std::string& text, X509& signer, EVP_PKEY& key) {
  constexpr int kFlags = PKCS7_DETACHED | PKCS7_TEXT | PKCS7_STREAM;
  const Bio in = reader_of(text), out = writer();
  const Signed signature{PKCS7_sign(&signer, &key, nullptr, in.get(), kFlags)};
  require(signature && SMIME_write_PKCS7(out.get(), signature.get(), in.get(), kFlags) == 1,
          "sign a document");
  return text_of(*out);
}

std::string verified(const std::string& smime, X509& signer) {
  BIO* content = nullptr;
  const Signed signature{SMIME_read_PKCS7(reader_of(smime).get(), &content)};
  const Bio text{content}, out = writer();
  if (!signature || !text) return "";
  const std::unique_ptr<STACK_OF(X509), void (*)(STACK_OF(X509)*)> signers{
      sk_X509_new_null(), [](STACK_OF(X509) * stack) { sk_X509_free(stack); }};
  sk_X509_push(signers.get(), &signer);
  // verifies with the given certificate only
  constexpr int kFlags = PKCS7_NOINTERN | PKCS7_NOVERIFY | PKCS7_TEXT;
  if (PKCS7_verify(signature.get(), signers.get(), nullptr, text.get(), out.get(), kFlags) != 1) return "";
  return text_of(*out);
}

}  // namespace crane::security::openssl
