/// Programs with other messages, types or qualities of service on the bus of a crane, and the findings of the
/// doctor.
#include <dds/dds.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

#include "../system/program_run.hpp"
#include "../system/running_stack.hpp"
#include "doctor/network.hpp"
#include "finding_lines.hpp"
#include "stack/data_files.hpp"

namespace crane::doctor {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::HasSubstr;

constexpr std::uint32_t kDomain = 88;

bus::Options options(bus::Vendor vendor, const std::string& participant) {
  bus::Options chosen;
  chosen.vendor = vendor;
  chosen.domain = kDomain;
  chosen.crane = system_test::crane_name();
  chosen.participant = participant;
  return chosen;
}

TEST(OnOneComputer, AProgramOfAnotherVersionIsShownByDoctorAndStatus) {
  system_test::RunningStack stack{kDomain, "virginia_tech_tower"};
  auto other = options(bus::Vendor::cyclone, "old_planner");
  other.messages_version = crane_MESSAGES_VERSION + 1;
  bus::Bus old{other};
  const auto say = [&](const std::vector<std::string>& command) {
    auto arguments = command;
    arguments.insert(arguments.end(),
                     {"--domain", std::to_string(kDomain), "--crane", system_test::crane_name()});
    return system_test::run_program(stack::program_directory() / "crane", arguments).output;
  };
  EXPECT_THAT(say({"status"}),
              HasSubstr("old_planner has messages of version 2, this program has version 1"));
  EXPECT_THAT(say({"status", "--json"}), HasSubstr("\"participant\": \"old_planner\""));
  EXPECT_THAT(say({"doctor", "--net"}), HasSubstr("problem  net  old_planner has messages of version 2"));
}

/// An endpoint of crane/state of another program on Cyclone DDS.
class ForeignEndpoint {
 public:
  /// @param change  sets the quality of service, which is otherwise that of the crane
  ForeignEndpoint(
      const dds_topic_descriptor_t& type, bool writes,
      const std::function<void(dds_qos_t*)>& change = [](dds_qos_t*) {})
      : participant_{dds_create_participant(kDomain, nullptr, nullptr)} {
    const std::string partition = system_test::crane_name(), name{topics::state.description.name};
    const auto topic = dds_create_topic(participant_, &type, name.c_str(), nullptr, nullptr);
    dds_qos_t* qos = dds_create_qos();
    const char* names = partition.c_str();
    dds_qset_partition(qos, 1, &names);
    const auto group = writes ? dds_create_publisher(participant_, qos, nullptr)
                              : dds_create_subscriber(participant_, qos, nullptr);
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(10));
    const dds_data_representation_id_t plain_cdr = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(qos, 1, &plain_cdr);
    change(qos);
    endpoint_ = writes ? dds_create_writer(group, topic, qos, nullptr)
                       : dds_create_reader(group, topic, qos, nullptr);
    dds_delete_qos(qos);
  }
  ~ForeignEndpoint() { dds_delete(participant_); }
  ForeignEndpoint(const ForeignEndpoint&) = delete;
  ForeignEndpoint& operator=(const ForeignEndpoint&) = delete;
  bool write(const void* sample) const { return dds_write(endpoint_, sample) == DDS_RETCODE_OK; }

 private:
  dds_entity_t participant_, endpoint_ = 0;
};

const dds_topic_descriptor_t& kState = *topics::state.description.descriptor;
const dds_topic_descriptor_t& kDemand = *topics::demand.description.descriptor;

/// The parameter is the DDS vendor of the doctor.
class ForeignProgram : public testing::TestWithParam<bus::Vendor> {
 protected:
  std::vector<std::string> found() {
    bus::Bus doctor{options(GetParam(), "doctor")};
    return lines(judge_mismatches(listen_on(doctor, 3s)));
  }
  /// On the loop-back, as all programs of this project by default; it also opens the domain of Cyclone DDS.
  bus::Bus crane_{options(bus::Vendor::cyclone, "crane_plant")};
};

TEST_P(ForeignProgram, WithTheSettingsOfTheCraneHasNoFinding) {
  const ForeignEndpoint writer{kState, true}, reader{kState, false};
  const auto states = crane_.publisher(topics::state);
  EXPECT_THAT(found(), testing::IsEmpty());
}

TEST_P(ForeignProgram, WithAnotherReliabilityIsNamedWithBothValues) {
  const ForeignEndpoint writer{
      kState, true, [](dds_qos_t* qos) { dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0); }};
  EXPECT_THAT(found(),
              Contains(testing::AllOf(HasSubstr("quality_of_service: a writer of crane/state ("),
                                      HasSubstr(") offers reliability best_effort, the readers of the "
                                                "crane request reliable: its samples do not arrive"))));
}

TEST_P(ForeignProgram, ThatRequestsMoreThanTheCraneOffersIsNamedWithBothValues) {
  const auto states = crane_.publisher(topics::state);
  const ForeignEndpoint reader{kState, false, [](dds_qos_t* qos) {
                                 dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
                                 dds_qset_deadline(qos, DDS_MSECS(20));
                               }};
  const auto all = found();
  EXPECT_THAT(all, Contains(testing::AllOf(
                       HasSubstr("quality_of_service: a reader of crane/state ("),
                       HasSubstr(") requests durability transient_local, the writer of the crane offers "
                                 "volatile: it receives no sample"))));
  EXPECT_THAT(all,
              Contains(HasSubstr("requests deadline 20000 us, the writer of the crane offers infinite")));
}

TEST_P(ForeignProgram, WithAnotherTypeIsNamedWithBothTypes) {
  const ForeignEndpoint writer{kDemand, true};
  EXPECT_THAT(found(), Contains(testing::AllOf(
                           HasSubstr("type_mismatch: a writer of crane/state ("),
                           HasSubstr(") has the type crane::Demand, the crane has crane::CraneState: "
                                     "no sample is exchanged"),
                           HasSubstr("generate the types of that program from crane.idl"))));
}

INSTANTIATE_TEST_SUITE_P(Doctor, ForeignProgram, testing::Values(bus::Vendor::cyclone, bus::Vendor::fastdds),
                         [](const auto& vendor) { return std::string{bus::to_string(vendor.param)}; });

/// The type has the right name and other fields: a program that was built from another IDL file.
TEST(OnOneComputer, SamplesOfAnotherTypeWithTheSameNameAreRejectedAndReported) {
  const bus::Bus crane{options(bus::Vendor::cyclone, "crane_plant")};
  constexpr auto kTypeInformation = static_cast<std::uint32_t>(DDS_TOPIC_XTYPES_METADATA);
  const dds_topic_descriptor_t type{.m_size = kDemand.m_size,
                                    .m_align = kDemand.m_align,
                                    .m_flagset = kDemand.m_flagset & ~kTypeInformation,
                                    .m_nkeys = kDemand.m_nkeys,
                                    .m_typename = kState.m_typename,
                                    .m_keys = kDemand.m_keys,
                                    .m_nops = kDemand.m_nops,
                                    .m_ops = kDemand.m_ops,
                                    .m_meta = kDemand.m_meta,
                                    .type_information = {},
                                    .type_mapping = {},
                                    .restrict_data_representation = 0};
  const ForeignEndpoint writer{type, true};
  std::jthread writing{[&writer](const std::stop_token& stop) {
    const msg::Demand sample{};
    std::mutex mutex;
    std::condition_variable_any stopped;
    std::unique_lock lock{mutex};
    while (!stopped.wait_for(lock, stop, 20ms, [&stop] { return stop.stop_requested(); }))
      EXPECT_TRUE(writer.write(&sample));
  }};
  bus::Bus doctor{options(bus::Vendor::fastdds, "doctor")};
  EXPECT_THAT(lines(judge_mismatches(listen_on(doctor, 3s))),
              Contains(testing::AllOf(HasSubstr("samples_rejected: "),
                                      HasSubstr(" samples of crane/state had a wrong CRC"))));
}

}  // namespace
}  // namespace crane::doctor
