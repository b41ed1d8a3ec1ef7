#pragma once
/// Publishes the recorded samples of the writers outside the replayed stack: clock master, operators, and the
/// supervisor when it is not replayed. Each writer has its recorded source and start-up number.
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "crane/bus/bus.hpp"
#include "replay/recorded_run.hpp"
#include "replay/samples.hpp"

namespace crane::replay {

class RecordedWriters {
 public:
  using BusOf = std::function<bus::Bus(const std::string& name, crane_Source source, std::uint32_t epoch)>;
  /// One participant publishes all samples of one client, because the supervisor accepts crane/jog only from
  /// the participant that requested the session. The participant announces its writers in the order of their
  /// creation: a process that answers a request has also discovered the writer of crane/jog.
  struct Operator {
    bus::Bus bus;
    bus::Publisher<msg::Jog> jogs;
    bus::Publisher<msg::Request> requests;
  };

  explicit RecordedWriters(BusOf bus_of) : bus_of_{std::move(bus_of)} {}

  /// Creates the writer of crane/state, before the first tick. @param first  its first sample
  void open_clock_master(const Cdr& first);
  /// @param configuration  replaces the configuration number of the sample when the replayed components run
  ///   another controller, because they would report the difference
  /// @return false when the sample is not valid or not sent
  bool publish_state(const Cdr& cdr, std::optional<std::uint32_t> configuration = std::nullopt);
  bool publish_supervisor(const Cdr& cdr);
  /// Publishes a request or a sample of crane/jog.
  bool publish_input(const Received& input);
  [[nodiscard]] Operator& operator_of(const msg::Header& header, const std::string& client);

 private:
  template <class T>
  struct Outside {
    bus::Bus bus;
    bus::Publisher<T> publisher;
  };
  template <class T>
  void open(std::unique_ptr<Outside<T>>& outside, const topics::Topic<T>& topic, const msg::Header& header);

  BusOf bus_of_;
  std::unique_ptr<Outside<msg::State>> clock_master_;
  std::unique_ptr<Outside<msg::SupervisorStatus>> supervisor_;
  std::map<std::string, Operator> operators_;
};

}  // namespace crane::replay
