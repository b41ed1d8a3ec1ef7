// Cyclone DDS serialises every topic to the same bytes as the codec of this project.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <gtest/gtest.h>

#include "../bus/random_sample.hpp"
#include "crane/bus/bus.hpp"

namespace crane::bus::testing {
namespace {

constexpr std::uint64_t kSeed = 3001;
constexpr dds_domainid_t kDomain = 47;

class CycloneSerializer {
 public:
  explicit CycloneSerializer(const topics::Description& topic) {
    domain_ =
        dds_create_domain(kDomain,
                          "<Domain id=\"any\"><General><AllowMulticast>false</AllowMulticast><Interfaces>"
                          "<NetworkInterface address=\"127.0.0.1\"/></Interfaces></General></Domain>");
    const dds_entity_t participant = dds_create_participant(kDomain, nullptr, nullptr);
    const dds_entity_t entity =
        dds_create_topic(participant, topic.descriptor, std::string{topic.name}.c_str(), nullptr, nullptr);
    dds_qos_t* qos = dds_create_qos();
    const dds_data_representation_id_t plain_cdr = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos, 1, &plain_cdr);
    reader_ = dds_create_reader(participant, entity, qos, nullptr);
    writer_ = dds_create_writer(participant, entity, qos, nullptr);
    dds_delete_qos(qos);
  }
  CycloneSerializer(const CycloneSerializer&) = delete;
  CycloneSerializer& operator=(const CycloneSerializer&) = delete;
  ~CycloneSerializer() { dds_delete(domain_); }

  /// @return bytes on the wire, encapsulation header first, padded to a multiple of four
  std::vector<std::uint8_t> bytes(const void* sample) {
    EXPECT_EQ(dds_write(writer_, sample), DDS_RETCODE_OK);
    ddsi_serdata* data = nullptr;
    dds_sample_info_t info{};
    if (dds_takecdr(reader_, &data, 1, &info, DDS_ANY_STATE) != 1) return {};
    std::vector<std::uint8_t> wire(ddsi_serdata_size(data));
    ddsi_serdata_to_ser(data, 0, wire.size(), wire.data());
    ddsi_serdata_unref(data);
    return wire;
  }

 private:
  dds_entity_t domain_ = 0, reader_ = 0, writer_ = 0;
};

TEST(Wire, CarriesWhatTheCodecEncodes) {
  Random random{kSeed};
  for (const auto& topic : topics::kAll) {
    const CdrCodec& codec = CdrCodec::of(*topic.descriptor);
    CycloneSerializer cyclone{topic};
    for (int i = 0; i < 100; ++i) {
      auto expected = encoded(codec, random_sample(codec, random).data());
      // Cyclone copies a struct's padding to the wire
      std::vector<std::uint8_t> sample(codec.sample_bytes(), 0);
      ASSERT_TRUE(codec.decode(expected, false, sample.data()));
      const auto padding = static_cast<std::uint8_t>((4 - expected.size() % 4) % 4);
      expected.insert(expected.begin(), {0, 1, 0, padding});
      expected.resize(expected.size() + padding, 0);
      ASSERT_EQ(cyclone.bytes(sample.data()), expected) << topic.name << ", seed " << kSeed;
    }
  }
}

}  // namespace
}  // namespace crane::bus::testing
