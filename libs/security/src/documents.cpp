#include "documents.hpp"

#include <ctime>
#include <fstream>
#include <sstream>

namespace crane::security {
namespace {

constexpr const char* kDomains = "<domains><id_range><min>0</min><max>100</max></id_range></domains>\n";

std::string opening(const char* schema) {
  return std::string{
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
             "<dds xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
             "xsi:noNamespaceSchemaLocation=\"http://www.omg.org/spec/DDS-SECURITY/20170901/"} +
         schema + "\">\n";
}

std::string utc(std::int64_t time_s) {
  const std::time_t time = time_s;
  std::tm parts{};
  ::gmtime_r(&time, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &parts);
  return text;
}

/// The name of a crane is a DDS partition. An identity is valid for all cranes of its authority.
std::string criteria(const char* kind, const std::vector<std::string_view>& names) {
  if (names.empty()) return "";
  std::string text = std::string{"<"} + kind + "><topics>";
  for (const auto name : names) text += "<topic>" + std::string{name} + "</topic>";
  return text + "</topics><partitions><partition>*</partition></partitions></" + kind + ">\n";
}

}  // namespace

std::string governance_document() {
  return opening("omg_shared_ca_governance.xsd") + "<domain_access_rules><domain_rule>\n" + kDomains +
         "<allow_unauthenticated_participants>false</allow_unauthenticated_participants>\n"
         "<enable_join_access_control>true</enable_join_access_control>\n"
         "<discovery_protection_kind>ENCRYPT</discovery_protection_kind>\n"
         "<liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>\n"
         "<rtps_protection_kind>NONE</rtps_protection_kind>\n"
         "<topic_access_rules><topic_rule><topic_expression>*</topic_expression>\n"
         "<enable_discovery_protection>true</enable_discovery_protection>\n"
         "<enable_liveliness_protection>true</enable_liveliness_protection>\n"
         "<enable_read_access_control>true</enable_read_access_control>\n"
         "<enable_write_access_control>true</enable_write_access_control>\n"
         "<metadata_protection_kind>ENCRYPT</metadata_protection_kind>\n"
         "<data_protection_kind>ENCRYPT</data_protection_kind>\n"
         "</topic_rule></topic_access_rules>\n"
         "</domain_rule></domain_access_rules>\n</dds>\n";
}

std::string permissions_document(const Role& role, const std::string& subject, const Validity& validity) {
  return opening("omg_shared_ca_permissions.xsd") + "<permissions><grant name=\"" + std::string{role.name} +
         "\">\n<subject_name>" + subject + "</subject_name>\n<validity><not_before>" + utc(validity.from_s) +
         "</not_before><not_after>" + utc(validity.until_s) + "</not_after></validity>\n<allow_rule>\n" +
         kDomains + criteria("publish", writes(role)) + criteria("subscribe", {"crane/*"}) +
         "</allow_rule>\n<default>DENY</default>\n</grant></permissions>\n</dds>\n";
}

std::string contents_of(const std::filesystem::path& file) {
  std::ifstream stream{file, std::ios::binary};
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace crane::security
