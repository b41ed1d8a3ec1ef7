// crane.idl contains its own fingerprint, so that a change of the messages without a new version is detected.
#include <gtest/gtest.h>

#include <cctype>
#include <cstdio>
#include <regex>
#include <string>

#include "crane/topics.hpp"
#include "crc32c.hpp"

namespace crane::bus {
namespace {

/// CRC-32C of the text without comments and white space.
std::string fingerprint(const std::string& idl) {
  std::string code = std::regex_replace(idl, std::regex{"//[^\n]*"}, "");
  std::erase_if(code, [](unsigned char c) { return std::isspace(c) != 0; });
  std::array<char, 9> hex{};
  std::snprintf(hex.data(), hex.size(), "%08x",
                crc32c({reinterpret_cast<const std::uint8_t*>(code.data()), code.size()}));
  return hex.data();
}

TEST(MessagesVersion, IsConsideredWheneverCraneIdlChanges) {
  const std::string idl{topics::idl_text()};
  const auto right = "// fingerprint " + fingerprint(idl) + "\n";
  EXPECT_NE(idl.find(right), std::string::npos)
      << "crane.idl has changed. If a struct or an enumeration of an earlier release has changed, raise "
         "MESSAGES_VERSION. Then replace the line with the fingerprint by \""
      << right.substr(0, right.size() - 1) << '"';
}

TEST(MessagesVersion, HasAFingerprintThatCommentsDoNotChange) {
  EXPECT_EQ(fingerprint("struct A { uint32 a; }; // one\n"),
            fingerprint("// two\nstruct A {\n  uint32 a;\n};\n"));
  EXPECT_NE(fingerprint("struct A { uint32 a; };"), fingerprint("struct A { uint32 b; };"));
}

}  // namespace
}  // namespace crane::bus
