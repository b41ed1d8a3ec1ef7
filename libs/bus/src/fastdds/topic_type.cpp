#include "fastdds/topic_type.hpp"

#include <fastrtps/utils/md5.h>

#include <algorithm>
#include <cstring>

namespace crane::bus::fastdds {

namespace rtps = eprosima::fastrtps::rtps;

namespace {
constexpr std::uint8_t kPlainBigEndian = 0;
constexpr std::uint8_t kPlainLittleEndian = 1;
}  // namespace

TopicType::TopicType(const dds_topic_descriptor_t& descriptor) : codec_{CdrCodec::of(descriptor)} {
  setName(descriptor.m_typename);
  constexpr std::size_t kPadding = 3;  // RTPS pads a payload to a multiple of four
  m_typeSize = static_cast<std::uint32_t>(codec_.max_encoded_bytes() + kEncapsulation_bytes + kPadding);
  m_isGetKeyDefined = codec_.has_key();
  auto_fill_type_object(false);  // a Cyclone DDS writer does not match a Fast DDS reader with a type object
  auto_fill_type_information(false);
}

bool TopicType::serialize(void* sample, rtps::SerializedPayload_t* payload) {
  if (payload->max_size < kEncapsulation_bytes) return false;
  const std::size_t bytes =
      codec_.encode(sample, {payload->data + kEncapsulation_bytes, payload->max_size - kEncapsulation_bytes});
  if (bytes == 0) return false;
  std::memset(payload->data, 0, kEncapsulation_bytes);
  payload->data[1] = kPlainLittleEndian;
  payload->encapsulation = CDR_LE;
  payload->length = static_cast<std::uint32_t>(bytes + kEncapsulation_bytes);
  return true;
}

bool TopicType::deserialize(rtps::SerializedPayload_t* payload, void* sample) {
  const std::span<const std::uint8_t> bytes{payload->data, payload->length};
  const bool plain = bytes.size() >= kEncapsulation_bytes && bytes[0] == 0 && bytes[1] <= kPlainLittleEndian;
  if (plain && codec_.decode(bytes.subspan(kEncapsulation_bytes), bytes[1] == kPlainBigEndian, sample))
    return true;
  std::memset(sample, 0, codec_.sample_bytes());  // all zeros is a sample with a wrong CRC
  return true;
}

std::function<std::uint32_t()> TopicType::getSerializedSizeProvider(void*) {
  return [size = m_typeSize] { return size; };
}

bool TopicType::getKey(void* sample, rtps::InstanceHandle_t* handle, bool force_md5) {
  if (!m_isGetKeyDefined) return false;
  std::array<std::uint8_t, 16> hash{};  // a key is one number, padded with zeros
  const std::size_t bytes = codec_.encode_key(sample, hash);
  if (bytes == 0) return false;
  if (force_md5) {
    MD5 md5;
    md5.init();
    md5.update(hash.data(), static_cast<unsigned int>(bytes));
    md5.finalize();
    std::copy_n(std::begin(md5.digest), hash.size(), hash.begin());
  }
  for (std::size_t i = 0; i < hash.size(); ++i) handle->value[i] = hash[i];
  return true;
}

void* TopicType::createData() { return ::operator new(codec_.sample_bytes()); }
void TopicType::deleteData(void* sample) { ::operator delete(sample); }

}  // namespace crane::bus::fastdds
