/// A foreign program with DDS writers that no bus of this project would create: another type, another time
/// stamp, a thousand writers.
#include <dds/dds.h>

#include <limits>

#include "armed_crane.hpp"
#include "crane/bus/seal.hpp"

namespace crane::hostile {
namespace {

/// A writer with the name of one topic and the type of another.
class OtherType {
 public:
  /// @param type_name  nullptr: the name of the type of `content`
  OtherType(std::uint32_t domain, const topics::Description& topic, const topics::Description& content,
            const char* type_name)
      : descriptor_{type_name == nullptr ? *content.descriptor : renamed(*content.descriptor, type_name)},
        participant_{dds_create_participant(domain, nullptr, nullptr)} {
    dds_qos_t* qos = dds_create_qos();
    const std::string crane = system_test::crane_name();
    const char* partition = crane.c_str();
    dds_qset_partition(qos, 1, &partition);
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(10));
    const dds_data_representation_id_t plain_cdr = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos, 1, &plain_cdr);
    const auto entity =
        dds_create_topic(participant_, &descriptor_, std::string{topic.name}.c_str(), nullptr, nullptr);
    const auto publisher = dds_create_publisher(participant_, qos, nullptr);
    writer_ = dds_create_writer(publisher, entity, qos, nullptr);
    dds_delete_qos(qos);
  }
  ~OtherType() { dds_delete(participant_); }
  OtherType(const OtherType&) = delete;
  OtherType& operator=(const OtherType&) = delete;
  /// @param time_ns  source time stamp
  bool write(const void* sample, std::int64_t time_ns) {
    return dds_write_ts(writer_, sample, time_ns) == DDS_RETCODE_OK;
  }
  [[nodiscard]] bool exists() const { return writer_ > 0; }
  [[nodiscard]] int matched() const {
    dds_publication_matched_status_t status{};
    dds_get_publication_matched_status(writer_, &status);
    return static_cast<int>(status.current_count);
  }

 private:
  /// Without the type information, which would show the disguise at discovery.
  static dds_topic_descriptor_t renamed(const dds_topic_descriptor_t& type, const char* name) {
    return {.m_size = type.m_size,
            .m_align = type.m_align,
            .m_flagset = type.m_flagset & ~static_cast<std::uint32_t>(DDS_TOPIC_XTYPES_METADATA),
            .m_nkeys = type.m_nkeys,
            .m_typename = name,
            .m_keys = type.m_keys,
            .m_nops = type.m_nops,
            .m_ops = type.m_ops,
            .m_meta = type.m_meta,
            .type_information = {},
            .type_mapping = {},
            .restrict_data_representation = type.restrict_data_representation};
  }

  dds_topic_descriptor_t descriptor_;
  dds_entity_t participant_, writer_ = 0;
};

TEST_F(ArmedCrane, IsNotSteeredByOtherTypesUnderTheNamesOfItsTopics) {
  msg::Event event{};
  std::ranges::fill(event.what, '5');
  event.what[sizeof event.what - 1] = 0;
  bus::seal(topics::event.description, &event, crane_SOURCE_OPERATOR, 3);
  for (const auto* topic :
       {&topics::request.description, &topics::jog.description, &topics::node.description}) {
    OtherType other{kDomain, *topic, topics::event.description, nullptr};
    OtherType disguised{kDomain, *topic, topics::event.description, topic->descriptor->m_typename};
    ASSERT_TRUE(other.exists() && disguised.exists());
    attack_for(300ms, [&] {
      (void)other.write(&event, dds_time());
      (void)disguised.write(&event, dds_time());
    });
    std::cout << topic->name << ": " << other.matched() << " and " << disguised.matched() << " readers\n";
  }
  expect_hold();
  for (const auto* topic : {&topics::command.description, &topics::demand.description}) {
    OtherType disguised{kDomain, *topic, topics::event.description, topic->descriptor->m_typename};
    attack_for(700ms, [&] { (void)disguised.write(&event, dds_time()); });
    std::cout << topic->name << ": " << disguised.matched() << " readers, "
              << experiments::in_words(stack_.observer().statuses().back()) << '\n';
  }
  expect_no_motion();
}

/// The supervisor determines the participant of each request, which is a search among all matched writers.
TEST_F(ArmedCrane, IsNotDisturbedByAThousandWritersOfRequests) {
  constexpr std::size_t kWriters = 1000;
  const auto participant = dds_create_participant(kDomain, nullptr, nullptr);
  dds_qos_t* qos = dds_create_qos();
  const std::string crane = system_test::crane_name();
  const char* partition = crane.c_str();
  dds_qset_partition(qos, 1, &partition);
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(10));
  const dds_data_representation_id_t plain_cdr = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos, 1, &plain_cdr);
  const auto& topic = topics::request.description;
  const auto entity =
      dds_create_topic(participant, topic.descriptor, std::string{topic.name}.c_str(), nullptr, nullptr);
  const auto publisher = dds_create_publisher(participant, qos, nullptr);
  msg::Request request{};
  request.kind = crane_REQUEST_MOVE;
  request.selected[0] = true;
  request.target[0] = 99;  // refused
  bus::seal(topic, &request, crane_SOURCE_OPERATOR, 3);
  std::vector<dds_entity_t> writers;
  std::size_t sent = 0;
  attack_for(5s, [&] {
    for (int i = 0; i < 10 && writers.size() < kWriters; ++i)
      writers.push_back(dds_create_writer(publisher, entity, qos, nullptr));
    for (int i = 0; i < 10; ++i) (void)dds_write(writers[sent++ % writers.size()], &request);
  });
  std::cout << writers.size() << " writers, " << sent << " requests\n";
  EXPECT_NO_THROW(stack_.session().request({.kind = crane_REQUEST_ESTOP}, "estop"));
  dds_delete(participant);
  dds_delete_qos(qos);
  expect_no_motion();
  for (const auto& [process, kb] : before_kb_)
    std::cout << process << ": memory grew by " << resident_kb(pid_of(process).value()) - kb << " kB\n";
}

/// Samples are delivered in the order of arrival. A time stamp of the year 2262 does not displace later
/// stops.
TEST_F(ArmedCrane, ObeysAStopAfterRequestsFromTheFuture) {
  msg::Request request{};
  request.id = 1;
  request.kind = crane_REQUEST_MOVE;
  request.selected[0] = true;
  request.target[0] = 99;  // refused
  bus::seal(topics::request.description, &request, crane_SOURCE_OPERATOR, 3);
  OtherType future{kDomain, topics::request.description, topics::request.description, nullptr};
  attack_for(500ms,
             [&] { EXPECT_TRUE(future.write(&request, std::numeric_limits<std::int64_t>::max() - 1)); });
  EXPECT_GT(future.matched(), 0);
  expect_hold();
  EXPECT_NO_THROW(stack_.session().request({.kind = crane_REQUEST_ESTOP}, "estop"));
}

}  // namespace
}  // namespace crane::hostile
