#pragma once
/// RTPS submessages that an attacker makes up: discovery of participants, and the reliable protocol.
#include "rtps.hpp"

namespace crane::hostile {

using EntityId = std::array<std::uint8_t, 4>;

inline constexpr EntityId kNoEntity{0, 0, 0, 0}, kParticipant{0, 0, 1, 0xC1};
inline constexpr EntityId kSpdpWriter{0, 1, 0, 0xC2}, kSpdpReader{0, 1, 0, 0xC7};

/// Header of a message of a participant.
[[nodiscard]] Bytes header(const GuidPrefix& prefix);
/// Appends a little-endian submessage.
void append(Bytes& message, std::uint8_t kind, std::uint8_t flags, const Bytes& content);

/// Entities of a DATA submessage: reader, then writer.
struct Entities {
  EntityId reader{}, writer{};
};
[[nodiscard]] Entities entities_of(const Bytes& message, const Submessage& data);
/// A message of the same participant with only this DATA submessage, for all readers of its writer.
[[nodiscard]] Bytes alone(const Bytes& message, const Submessage& data);

/// Announces a participant with an infinite lease, whose locators lead nowhere.
[[nodiscard]] Bytes participant(const GuidPrefix& prefix, std::uint32_t domain);
/// Announces the end of a participant.
[[nodiscard]] Bytes end_of_participant(const GuidPrefix& prefix);
/// A HEARTBEAT of a writer with the samples `first` to `last`.
[[nodiscard]] Bytes heartbeat(const GuidPrefix& prefix, const EntityId& writer, std::uint64_t first,
                              std::uint64_t last);
/// A HEARTBEAT of a writer whose history begins and ends with `number`: its readers skip all earlier samples.
[[nodiscard]] Bytes heartbeat(const GuidPrefix& prefix, const EntityId& writer, std::uint64_t number);
/// A GAP: the samples from `first` to before `next` do not exist, nor those of the `bits` numbers from `next`
/// on.
[[nodiscard]] Bytes gap(const GuidPrefix& prefix, const EntityId& writer, std::uint64_t first,
                        std::uint64_t next, std::uint32_t bits);
/// Position and sizes of a fragment, as the packet states them.
struct Fragment {
  std::uint32_t number = 1;        ///< of the first fragment in the packet, from 1 on
  std::uint16_t count = 1;         ///< of fragments in the packet
  std::uint16_t bytes = 1024;      ///< of each fragment
  std::uint32_t sample_bytes = 0;  ///< of the whole sample
  Bytes payload = Bytes(1024);
};
[[nodiscard]] Bytes fragment(const GuidPrefix& prefix, const EntityId& writer, std::uint64_t number,
                             const Fragment& fragment);
/// The first fragment of a sample of 2 GB.
[[nodiscard]] Bytes fragment(const GuidPrefix& prefix, const EntityId& writer, std::uint64_t number);
/// Content of INFO_SRC: the following submessages belong to another participant.
[[nodiscard]] Bytes source(const GuidPrefix& prefix);
/// Content of an ACKNACK that requests 256 samples from `first` on. @param entities  reader, then writer
[[nodiscard]] Bytes repeat_all(Bytes entities, std::uint64_t first, std::uint32_t count);

}  // namespace crane::hostile
